"""What the numbers belong to: the machine, the system and the day."""

from __future__ import annotations

import datetime as dt
import os
import platform
from pathlib import Path

UNKNOWN = "not known"


def field(path: Path, name: str) -> str:
    """Read ``name : value`` out of a file of the kernel."""
    if not path.exists():
        return UNKNOWN
    for line in path.read_text().splitlines():
        key, _, value = line.partition(":")
        if key.strip() == name:
            return value.strip()
    return UNKNOWN


def processor() -> str:
    """Name the processor, with the family that tells generations of one name apart."""
    info = Path("/proc/cpuinfo")
    model = field(info, "model name")
    if model == UNKNOWN:
        return platform.processor() or UNKNOWN
    return f"{model} (family {field(info, 'cpu family')}, model {field(info, 'model')})"


def memory() -> str:
    """Tell the memory of the machine."""
    kilobytes = field(Path("/proc/meminfo"), "MemTotal").split()[0]
    return f"{int(kilobytes) / 2**20:.0f} GiB" if kilobytes.isdigit() else UNKNOWN


def facts() -> list[tuple[str, str]]:
    """List what the report says about where and when."""
    return [
        ("date", dt.datetime.now(dt.UTC).strftime("%Y-%m-%d")),
        ("processor", processor()),
        ("cores", str(os.cpu_count() or UNKNOWN)),
        ("memory", memory()),
        ("system", f"{platform.system()} {platform.machine()}"),
        ("Python", platform.python_version()),
    ]
