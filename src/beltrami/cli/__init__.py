"""The command line: one file for each verb."""

from __future__ import annotations


def main() -> None:
    """Run ``beltrami``: the entry point of the command."""
    from beltrami.cli.app import run  # the command line is not loaded with the package

    run()
