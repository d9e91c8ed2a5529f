"""The order of elimination and the pattern of the factors, against elimination by hand."""

import numpy as np
import pytest

from trsim.assemble.elimination import elimination


def graph(pairs, n):
    near = [set() for _ in range(n)]
    for a, b in pairs:
        near[a].add(b)
        near[b].add(a)
    return near


def chain(n):
    """Bodies 0..n-1 with a spring and a joint from each to the next; the first joint on nobody."""
    pairs = [(k, k + 1) for k in range(n - 1)]
    pairs += [(n + k, body) for k in range(n) for body in (k - 1, k) if body >= 0]
    return graph(pairs, 2 * n), [3] * n + [2] * n, n


def loops(n, seed):
    """Bodies joined at random, closed loops and all."""
    rng = np.random.default_rng(seed)
    pairs = [(k, int(rng.integers(k))) for k in range(1, n)]
    joints = [rng.choice(n, 2, replace=False).tolist() for _ in range(n)]
    pairs += [(n + k, body) for k, joint in enumerate(joints) for body in joint]
    return graph(pairs, 2 * n), [int(s) for s in rng.integers(1, 4, 2 * n)], n


CASES = {"chain": chain(7), "loops": loops(9, 1), "more loops": loops(12, 2)}


def dense_pattern(near, size):
    """Where a matrix of dense blocks has entries, unknown by unknown."""
    node = np.repeat(np.arange(len(size)), size)
    full = np.array([[a == b or b in near[a] for b in range(len(size))] for a in range(len(size))])
    return full[np.ix_(node, node)]


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_the_factors_have_room_for_all_fill(case):
    near, size, free = case
    found = elimination(near, size, free)
    n = sum(size)
    assert sorted(found.rank) == list(range(n))
    A = np.zeros((n, n), bool)
    A[np.ix_(found.rank, found.rank)] = dense_pattern(near, size)
    for k in range(n):
        below = k + 1 + np.flatnonzero(A[k + 1 :, k])
        A[np.ix_(below, k + 1 + np.flatnonzero(A[k, k + 1 :]))] = True
    for k in range(n):
        right = found.column[found.start[k] : found.start[k + 1]]
        left = found.lower[found.lower_start[k] : found.lower_start[k + 1]]
        assert set(k + 1 + np.flatnonzero(A[k, k + 1 :])) <= set(right)
        assert set(np.flatnonzero(A[k, :k])) <= set(left)
        assert np.all(np.diff(right) > 0) and np.all(right > k)
        assert np.all(np.diff(left) > 0) and np.all(left < k)


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_constraints_come_after_all_they_act_on(case):
    near, size, free = case
    rank = elimination(near, size, free).rank
    first = np.concatenate([[0], np.cumsum(size)])
    for joint in range(free, len(size)):
        for body in near[joint]:
            assert rank[first[body]] < rank[first[joint]]


def test_nothing_is_changed():
    near, size, free = chain(5)
    elimination(near, size, free)
    assert near == chain(5)[0]


def test_fill_of_a_chain_grows_with_its_length():
    entries = {n: len(elimination(*chain(n)).lower) for n in (40, 160, 640)}
    print(f"entries below the diagonal: {entries}")
    per_body = [entries[n] / n for n in (40, 160, 640)]
    assert max(per_body) < 1.05 * min(per_body)
