"""Start the benchmarks: first the threads, then everything that may load numpy."""

from __future__ import annotations

from benchmarks.threads import one_thread


def start() -> int:
    one_thread()
    from benchmarks.command import main  # loads numpy, so it comes after the threads

    return main()


if __name__ == "__main__":
    raise SystemExit(start())
