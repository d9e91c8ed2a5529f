"""docs/python.md: every block runs as written, in its order, and gives what stands there."""

import doctest
import re
import warnings

import trsim
from tests.test_circles import ROOT

PAGE = (ROOT / "docs/python.md").read_text(encoding="utf-8")
FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def test_blocks(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = "\n".join(BLOCK.findall(PAGE))
    test = doctest.DocTestParser().get_doctest(text, {}, "docs/python.md", None, 0)
    assert len(test.examples) > 25
    told: list[str] = []
    runner = doctest.DocTestRunner(optionflags=FLAGS)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", trsim.TrsimWarning)
        runner.run(test, out=told.append)
    assert not runner.failures, "".join(told)


def test_every_block_is_one_of_these():
    assert len(re.findall("^```", PAGE, re.MULTILINE)) == 2 * len(BLOCK.findall(PAGE))


def test_what_there_is_stands_in_the_page():
    """Every name of the package and every public part of a result."""
    for name in trsim.__all__:
        assert name.startswith("_") or name == "Checked" or name in PAGE, name
    for name in (name for name in vars(trsim.Result) if not name.startswith("_")):
        assert re.search(rf"\b{name}\b", PAGE), name
