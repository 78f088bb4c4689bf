"""What tests of several rooms share: this folder is importable; how hypothesis runs."""

from __future__ import annotations

import sys
from pathlib import Path

from hypothesis import HealthCheck, settings

sys.path.insert(0, str(Path(__file__).parent))

# Derandomized: a run tells about the code, not about luck. `-m heavy` draws anew each time.
settings.register_profile(
    "beltrami",
    deadline=None,  # the first call of a kernel compiles it
    derandomize=True,
    max_examples=50,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
settings.load_profile("beltrami")
