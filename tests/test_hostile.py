"""Hostile files and expressions are settled quickly, and nothing is opened, run or connected."""

import gc
import random
import time

import pytest

from trsim.errors import ScenarioError, TrsimError
from trsim.expressions import evaluate, names, parse
from trsim.scenario.load import load

from .checking import written
from .scenario.test_text import HOSTILE
from .sizes import size
from .store.outside import ROOT, started
from .test_expressions import REFUSED
from .watching import NETWORK, PROCESSES, Watch, apart

FILES = {text.encode("utf-8", "surrogatepass") for text in HOSTILE} | {
    b"a: 1e400",
    b"\xff\xfe" + "title: x".encode("utf-16-le"),
    "title: \xef".encode("latin-1"),
    b"\x00" * 1000,
    b"\n" * 900_000,
    b"#" * 2_000_000,
    b"bodies: {a: {mass: " + b"1" * 5000 + b"}}",
    b"parameters: {" + b", ".join(b"p%d: p%d" % (k + 1, k) for k in range(2000)) + b"}",
    b"bodies:\n" + b"".join(b"  b%d: {mas: 1}\n" % k for k in range(1000)),
    b"extends: [" + b"a.yaml, " * 5000 + b"]",
    b"title: " + b"'" * 999_999,
    b"forces: {a: {type: applied_load, body: b, direction: [1, 0], force: " + b"(" * 999 + b"}}",
}
PIECES = ["9", "**", "(", ")", "t", ".", "e9", "+", "-", "/", "*", ",", "sin", "min(", "exp("]
PIECES += ["__class__", "open", "lambda", ":", "[", "'", "x", " ", "<", "=", "1e308", "step("]
EXPRESSIONS = size(5_000, 50_000)


@pytest.fixture
def alone():
    """What other tests left in memory is not looked through while ours are timed."""
    gc.collect()
    gc.freeze()
    yield
    gc.unfreeze()


def test_files(alone, tmp_path):
    slowest = []
    for data in sorted(FILES):
        target = written(tmp_path / "hostile.yaml", data)
        start = time.process_time()
        with pytest.raises(TrsimError) as caught:
            load(target)
        slowest.append((time.process_time() - start, data[:30]))
        assert caught.value.exit_code == 3
        assert len(caught.value.show()) < 20_000
    took, data = max(slowest)
    print(f"{len(FILES)} hostile files, the slowest {1e3 * took:.0f} ms: {data!r}")
    assert len(FILES) >= 40


def test_expressions():
    """No file is opened, no code run: not even for an error."""
    dice = random.Random(1)
    texts = ["".join(dice.choices(PIECES, k=dice.randint(1, 30))) for _ in range(EXPRESSIONS)]

    def tried():
        slowest = 0.0
        with Watch(("open", "exec", *NETWORK, *PROCESSES)) as seen:
            for text in [*REFUSED, *texts]:
                start = time.process_time()
                try:
                    node = parse(text)
                    evaluate(node, dict.fromkeys(names(node), 0.5))
                except ScenarioError:
                    pass
                slowest = max(slowest, time.process_time() - start)
        return seen, slowest

    seen, slowest = apart(tried)
    assert seen == []
    assert len(REFUSED) >= 16
    print(f"{len(REFUSED) + len(texts)} expressions, the slowest {1e3 * slowest:.1f} ms")


def test_a_schema_error_imports_no_compiler():
    """What makes it quick: the elements are read without numba, numpy or h5py."""
    code = (
        "import sys\nfrom trsim.errors import TrsimError\n"
        "from trsim.scenario.load import load, loads\n"
        "from trsim import elements\n"
        "load('scenarios/thrust_reverser/clearance_ab_0.3mm.yaml')\n"
        "for word in elements.ELEMENTS: elements.load(word)\n"
        "print(sorted({'numpy', 'numba', 'llvmlite', 'scipy', 'h5py'} & set(sys.modules)))"
    )
    out, _ = started(ROOT, "-c", code).communicate()
    assert out == "[]\n"
