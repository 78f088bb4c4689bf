"""Make a separator smaller by moving its vertices to a side (C. Fiduccia, R. Mattheyses, 1982).

A vertex that moves to one side pulls its neighbours of the other side into the separator. The
moves that pull fewest are made, also where the separator grows for a while; the smallest separator
that was met is kept.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import kernel

_PASSES = 2
_PATIENCE = 16  # moves without gain; besides them a quarter of the separator
_SMALLEST = 0.35  # part of a set that each side keeps


@kernel
def refine(
    indptr: Any,
    indices: Any,
    owner: Any,
    mine: int,
    sizes: Any,
    found: Any,
    near: Any,
    state: Any,
    log: Any,
    steps: Any,
) -> None:
    """Make a separator smaller: owners are mine and mine + 1 on the sides, mine + 2 on it.

    ``sizes`` (3,) are those of the sides and of the separator, ``found`` starts with its vertices;
    both are kept up to date. Workspace: ``near`` (n, 2), ``state`` (n,) zero before and after,
    ``log`` and ``steps`` (n,).
    """  # fmt: skip
    if min(sizes[0], sizes[1]) == 0:  # a separator of nothing is no cut: keep it
        return
    smallest = max(1, int(_SMALLEST * (sizes[0] + sizes[1] + sizes[2])))
    for _ in range(_PASSES):
        before = sizes[2]
        for t in range(np.uint64(before)):
            _count(indptr, indices, owner, mine, found[t], near)
            state[found[t]] = 0
        made, best, best_made, since = 0, before, 0, 0
        balance = abs(sizes[0] - sizes[1])
        logged = 0
        while since < _PATIENCE + before // 4 and made < steps.size:
            at, side = _choose(found, sizes, near, state, smallest)
            if at < 0:
                break
            v = found[at]
            pulls = near[v, 1 - side]
            if logged + pulls + 1 > log.size:
                break
            sizes[2] -= 1
            found[at] = found[sizes[2]]
            _move(indptr, indices, owner, mine, v, side, sizes, found, near, log, logged)
            state[v] = 1
            logged += pulls + 1
            steps[made] = 2 * pulls + side
            made += 1
            since += 1
            unequal = abs(sizes[0] - sizes[1])
            if sizes[2] < best or (sizes[2] == best and unequal < balance):
                since = 0 if sizes[2] < best else since
                best, balance, best_made = sizes[2], unequal, made
        alive = sizes[2]
        _undo(owner, mine, sizes, log, logged, steps, made, best_made)
        _collect(owner, mine, found, alive, state, log, logged)
        if sizes[2] >= before:
            break


@kernel
def _count(indptr: Any, indices: Any, owner: Any, mine: int, v: Any, near: Any) -> None:
    """Count the neighbours of v on either side."""
    here = there = 0
    for q in range(indptr[v], indptr[v + np.uint64(1)]):
        at = owner[np.uint64(indices[q])] - mine
        if at == 0:
            here += 1
        elif at == 1:
            there += 1
    near[v, 0], near[v, 1] = here, there


@kernel
def _choose(found: Any, sizes: Any, near: Any, state: Any, smallest: int) -> Any:
    """Return (place, side) of the move that pulls fewest; of equal ones that to the smaller side.

    The place is -1 if none is left that keeps both sides large enough.
    """
    least, at, to = 1 << 40, np.int64(-1), 0
    first = 0 if sizes[0] <= sizes[1] else 1
    room_first, room_other = sizes[1 - first] - smallest, sizes[first] - smallest
    for t in range(np.uint64(sizes[2])):
        v = found[t]
        if state[v]:
            continue
        pulls = near[v, 1 - first]
        if pulls < least and pulls <= room_first:
            least, at, to = pulls, np.int64(t), first
        pulls = near[v, first]
        if pulls < least and pulls <= room_other:
            least, at, to = pulls, np.int64(t), 1 - first
        if least == 0:
            break
    return at, to


@kernel
def _move(
    indptr: Any,
    indices: Any,
    owner: Any,
    mine: int,
    v: Any,
    side: int,
    sizes: Any,
    found: Any,
    near: Any,
    log: Any,
    logged: int,
) -> None:
    """Move v to a side; its neighbours on the other go to the end of what is found, and the log."""
    one = np.uint64(1)
    other = 1 - side
    owner[v] = mine + side
    sizes[side] += 1
    for q in range(indptr[v], indptr[v + one]):
        w = np.uint64(indices[q])
        at = owner[w] - mine
        if at == 2:
            near[w, side] += 1
        elif at == other and w != v:
            owner[w] = mine + 2
            found[sizes[2]] = w
            log[logged] = w
            sizes[2] += 1
            sizes[other] -= 1
            logged += 1
            _count(indptr, indices, owner, mine, w, near)
            for r in range(indptr[w], indptr[w + one]):
                u = np.uint64(indices[r])
                if owner[u] == mine + 2 and u != w:
                    near[u, other] -= 1
    log[logged] = v


@kernel
def _undo(
    owner: Any, mine: int, sizes: Any, log: Any, logged: int, steps: Any, made: int, kept: int
) -> None:
    """Take the moves back, the last first, until so many are kept."""
    while made > kept:
        made -= 1
        pulls, side = steps[made] // 2, steps[made] % 2
        logged -= 1
        owner[log[logged]] = mine + 2
        for _ in range(pulls):
            logged -= 1
            owner[log[logged]] = mine + 1 - side
        sizes[side] -= 1
        sizes[1 - side] += pulls
        sizes[2] += 1 - pulls


@kernel
def _collect(
    owner: Any, mine: int, found: Any, alive: int, state: Any, log: Any, logged: int
) -> None:
    """List the separator: what is left of the old list, and what has moved in between."""
    count = 0
    for t in range(alive + logged):
        v = found[t] if t < alive else log[t - alive]
        if owner[v] == mine + 2 and state[v] < 2:
            state[v] = 2
            found[count] = v
            count += 1
    for t in range(count):
        state[found[t]] = 0
    for t in range(logged):
        state[log[t]] = 0
