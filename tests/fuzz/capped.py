"""Read the corpus, and changes of it, with little memory: ``python -m fuzz.capped ROUNDS SEED``.

The first reading loads the libraries and the kernels; from then on the inputs, which are smaller
than a kilobyte, may take ``ROOM`` more, and each of them ``PATIENCE`` seconds.
"""

import resource
import signal
import sys

import numpy as np

from fuzz import readers

ROOM = 64 << 10  # kilobytes
PATIENCE = 20


def resident():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def main():
    rounds, seed = int(sys.argv[1]), int(sys.argv[2])
    rng = np.random.default_rng(seed)
    inputs = {name: readers.corpus(name) for name in readers.TARGETS}
    for name, kept in inputs.items():
        for data in kept:
            readers.outcome(name, data)
    before = resident()
    resource.setrlimit(resource.RLIMIT_AS, (6 << 30, 6 << 30))
    for name, kept in inputs.items():
        for number in range(rounds):
            data = readers.mutated(rng, kept)
            signal.alarm(PATIENCE)
            try:
                readers.outcome(name, data)
            except BaseException:
                sys.stderr.write(f"{name}, input {number} of seed {seed}: {data!r}\n")
                raise
            signal.alarm(0)
    grown = resident() - before
    assert grown < ROOM, f"{grown} kilobytes for inputs of less than one"


if __name__ == "__main__":
    main()
