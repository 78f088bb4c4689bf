from hypothesis import given
from hypothesis import strategies as st

from beltrami._progress import stages


@given(st.integers(0, 50), st.integers(1, 60))
def test_blocks_add_up_and_progress_tells_of_each(total, block):
    told = []
    sizes = list(stages(total, lambda *at: told.append(at), block))
    assert sum(sizes) == total
    assert all(size == block for size in sizes[:-1])
    assert all(0 < size <= block for size in sizes)
    assert told == [(sum(sizes[: k + 1]), total) for k in range(len(sizes))]


def test_progress_is_told_after_the_work_not_before():
    events = []
    for size in stages(3, lambda done, total: events.append(f"told {done}"), block=2):
        events.append(f"did {size}")
    assert events == ["did 2", "told 2", "did 1", "told 3"]


def test_work_given_up_is_not_told():
    told = []
    for _ in stages(5, lambda *at: told.append(at)):
        break
    assert told == []


def test_nobody_need_listen():
    assert list(stages(3, None)) == [1, 1, 1]
