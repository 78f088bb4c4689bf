"""The audit fails where it could not look: nothing in its recipe hides an exit code."""

import re
from pathlib import Path

MAKEFILE = (Path(__file__).parents[1] / "Makefile").read_text(encoding="utf-8")


def recipe(target):
    found = re.search(rf"^{target}:.*\n((?:\t.*\n)+)", MAKEFILE, re.MULTILINE)
    return [line.strip() for line in found[1].splitlines()]


def test_every_line_of_the_audit_may_fail():
    lines = recipe("audit")
    assert not any(
        line.startswith("-") or re.search(r"\|\||;|\| *tail|true", line) for line in lines
    )
    assert any("cyclonedx-py environment" in line for line in lines)
    assert "pip-audit --strict" in lines[-1]
    assert "skip" not in lines[-1]
    assert ".IGNORE" not in MAKEFILE
