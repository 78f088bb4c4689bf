"""The viewer's modules under node: `node --test`, without a browser."""

import subprocess
from pathlib import Path

import pytest

from browsers import node

pytestmark = pytest.mark.browser  # playwright brings node

HERE = Path(__file__).parent / "web"


@pytest.mark.parametrize("file", sorted(HERE.glob("*.test.mjs")), ids=lambda p: p.name)
def test_module(file):
    done = subprocess.run(
        [node(), "--test", str(file)], capture_output=True, text=True, check=False, timeout=120
    )
    assert done.returncode == 0, done.stdout[-4000:]
    assert "# pass 0" not in done.stdout
