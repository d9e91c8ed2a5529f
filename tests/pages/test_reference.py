"""docs/reference.md is what the specs say."""

from benchmarks.docs.marks import marked
from benchmarks.docs.reference import PAGE, page
from trsim.scenario.explain import explained


def test_the_page_is_that_of_the_specs():
    text = PAGE.read_text(encoding="utf-8")
    mark = text.splitlines()[marked(PAGE, text)[0].line - 1]
    assert text == page(mark), "make it again: make docs NAMES=reference"


def test_it_has_every_key_and_channel():
    text, every = page("mark"), explained()
    sections, elements = text.split("\n## Elements\n")
    for one in (*every["elements"], *every["sections"]):
        part = elements if one in every["elements"] else sections
        own = part.split(f"\n### {one['word']}\n")[1].split("\n### ")[0]
        for key in one["keys"]:
            assert f"| `{key['place'].removeprefix(one['word'] + '.')}`" in own, key["place"]
        for channel in one.get("channels", ()):
            assert f"| `{channel['name']}` |" in own
