"""Animations as files: the .glb, the command, and the page in a browser."""

import base64
import re

import numpy as np
import pytest

from trsim.cli import main
from trsim.errors import UsageError
from trsim.report.animation import film, section, turns, write
from trsim.report.animation.motion import FRAMES, motion

from .browser import CHROMIUM, browser
from .filmed import arrays, of

X = np.array([1.0, 0.0, 0.0])

# --- the file --------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["crank", "bar", "hatch"])
def test_glb(name, request):
    """Valid where programs are strict: bounds, unit quaternions, indices, lengths, targets."""
    run = request.getfixturevalue(name)
    data = film(run).glb
    gltf, found = arrays(data)
    assert int.from_bytes(data[8:12], "little") == len(data)
    assert gltf.buffers[0].byteLength == len(gltf.binary_blob())
    for accessor, values in zip(gltf.accessors, found, strict=True):
        if accessor.min:
            assert accessor.min == values.min(axis=0).tolist()
            assert accessor.max == values.max(axis=0).tolist()
    for mesh in gltf.meshes:
        for part in mesh.primitives:
            assert gltf.accessors[part.attributes.POSITION].min
            assert found[part.indices].max() < len(found[part.attributes.POSITION])
            assert len(found[part.attributes.NORMAL]) == len(found[part.attributes.POSITION])
    (animation,) = gltf.animations
    assert len({(c.target.node, c.target.path) for c in animation.channels}) == len(
        animation.channels
    )
    time = run.time
    for channel in animation.channels:
        sampler = animation.samplers[channel.sampler]
        times, values = found[sampler.input][:, 0], found[sampler.output]
        assert len(times) == len(values) == min(len(time), FRAMES)
        assert gltf.accessors[sampler.input].max == [pytest.approx(time[-1] - time[0])]
        assert (np.diff(times) > 0.0).all()
        if channel.target.path == "rotation":
            assert np.linalg.norm(values, axis=1) == pytest.approx(np.ones(len(values)), abs=1e-6)


def test_bodies_move_in_the_glb(crank):
    """The node of a body has the recorded places."""
    gltf, found = arrays(film(crank).glb)
    names = [node.name for node in gltf.nodes]
    (animation,) = gltf.animations
    paths = {(names[c.target.node], c.target.path): animation.samplers[c.sampler].output
             for c in animation.channels}  # fmt: skip
    place = found[paths["rod", "translation"]]
    assert place == pytest.approx(crank.channel("rod.position"), abs=1e-7)


def test_bars_follow_their_nodes(bar):
    """A tube begins at its node and ends at the next one."""
    gltf, found = arrays(film(bar).glb)
    names = [node.name for node in gltf.nodes]
    (animation,) = gltf.animations
    tracks = {c.target.path: found[animation.samplers[c.sampler].output]
              for c in animation.channels if c.target.node == names.index("rod 2")}  # fmt: skip
    size = tracks["scale"][:, :1].astype(float)
    end = tracks["translation"] + size * turns.turned(tracks["rotation"].astype(float), X)
    assert end == pytest.approx(bar.channel("rod.node3.position")[motion(bar).rows], abs=1e-6)


def test_magnified(crank):
    """The journal goes 50 times as far from the middle of its bearing, bodies go where they did."""
    usual, large = (arrays(film(crank, times).glb) for times in (1.0, 50.0))
    place = []
    for gltf, found in (usual, large):
        names = [node.name for node in gltf.nodes]
        (animation,) = gltf.animations
        tracks = {names[c.target.node]: found[animation.samplers[c.sampler].output].astype(float)
                  for c in animation.channels if c.target.path == "translation"}  # fmt: skip
        place.append(tracks["B journal"] - tracks["B bearing"])
        assert tracks["slider"] == pytest.approx(crank.channel("slider.position"), abs=1e-7)
    assert np.linalg.norm(place[0], axis=1).max() > 4e-4
    assert place[1] == pytest.approx(50.0 * place[0], abs=1e-5)
    assert "drawn 50 times" in section(crank, 50.0) and "journals" not in section(crank)
    with pytest.raises(UsageError, match="cannot be drawn"):
        film(crank, 0.0)


# --- the command and the page ----------------------------------------------------------------


def ended(*arguments):
    """The exit code of a command line."""
    with pytest.raises(SystemExit) as end:
        main(list(arguments))
    return end.value.code


def test_command(crank, tmp_path):
    """Both files, the second time over the first; files of others are left."""
    arguments = ["report", str(crank.path), "-o", str(tmp_path / "out"), "--animate"]
    assert ended(*arguments) == 0 == ended(*arguments)
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [
        "animation.glb", "animation.html",
    ]  # fmt: skip
    assert ended(*arguments, str(crank.path)) == 2
    assert ended(*arguments, "--compare") == 2
    assert ended("report", str(crank.path), "--magnify-clearance", "5") == 2
    (tmp_path / "out" / "animation.html").write_text("mine")
    assert ended(*arguments) == 2
    assert (tmp_path / "out" / "animation.html").read_text() == "mine"


def test_page_stands_alone(crank, tmp_path):
    """It holds the .glb, asks nobody for anything, and forbids it."""
    (glb, page), _ = write(crank.path, tmp_path)
    text = page.read_text(encoding="utf-8")
    (data,) = re.findall(r'class="glb">([^<]*)<', text)
    assert base64.b64decode(data) == glb.read_bytes()
    assert not re.search(r"https?:|//[a-z]+\.|@import|src=|href=|fetch\(|XMLHttp", text)
    assert "default-src 'none'" in text


def test_titles_are_text(crank, tmp_path):
    run = of(tmp_path, "title=</script><b>&")
    text = section(run)
    assert "<b>" not in text and "&lt;b&gt;" in text


in_browser = pytest.mark.skipif(CHROMIUM is None, reason="needs chromium, to play the page in it")
SECTION = "document.querySelector('section.animation')"


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    with browser(tmp_path_factory.mktemp("browser")) as found:
        yield found


@in_browser
@pytest.mark.parametrize("name", ["crank", "bar"])
def test_plays(name, page, request, tmp_path):
    """By itself it draws frame after frame, the time goes on, and nobody is asked for anything."""
    run = request.getfixturevalue(name)
    (_, file), _ = write(run.path, tmp_path)
    page.open(file)
    told = page.until(f"{SECTION}?.dataset.drawn > 5", f"({{...{SECTION}.dataset}})")
    assert told["state"] == "ready"
    assert 0.0 < float(told["time"]) <= run.time[-1]
    assert page.requests == [file.as_uri()]


@in_browser
def test_slider(page, crank, tmp_path):
    """It stops the motion and goes to a time; the clock tells it."""
    (_, file), _ = write(crank.path, tmp_path)
    page.open(file)
    page.until(f"{SECTION}?.dataset.drawn > 0", "0")
    slider = "document.querySelector('.time')"
    page.value(f"{slider}.value = 0.5, {slider}.dispatchEvent(new Event('input'))")
    clock = page.until(
        f"Math.abs({SECTION}.dataset.time - 0.0015) < 1e-9",
        "document.querySelector('.clock').value",
    )
    assert clock == "t = 0.0015000 s"
    assert page.until("true", "document.querySelector('.play').textContent") == "Play"


@in_browser
def test_drawn(page, crank, tmp_path):
    """Bodies and arrow are seen in their colours, elsewhere at another time."""
    from PIL import Image

    (_, file), _ = write(crank.path, tmp_path)
    force = np.linalg.norm(crank.channel("B.force"), axis=1)
    pictures = []
    for t in (crank.time[0], crank.time[int(force.argmax())]):
        page.open(file, f"#t={t:.9g}")
        box = page.until(
            f"{SECTION}?.dataset.drawn > 0",
            "(b => [b.left, b.top, b.right, b.bottom])(document.querySelector('canvas')"
            ".getBoundingClientRect())",
        )
        page.picture(tmp_path / "page.png")
        with Image.open(tmp_path / "page.png") as image:
            pictures.append(np.asarray(image.convert("RGB").crop(box), dtype=float))
    for picture in pictures:  # crank, rod, slider
        assert all((hues(picture) == hue).sum() > 40 for hue in ("blue", "orange", "green"))
    assert (hues(pictures[0]) != hues(pictures[1])).sum() > 500
    assert (hues(pictures[1]) == "red").sum() > 40 > (hues(pictures[0]) == "red").sum()


@in_browser
def test_view(page, hatch, tmp_path):
    """All of the motion is in the first picture, and `Reset view` goes back to it."""
    from PIL import Image

    (_, file), _ = write(hatch.path, tmp_path)
    canvas = "document.querySelector('canvas')"

    def seen(drawn):
        box = page.until(f"{SECTION}?.dataset.drawn > {drawn}",
                         f"(b => [b.left, b.top, b.right, b.bottom])({canvas}"
                         ".getBoundingClientRect())")  # fmt: skip
        page.picture(tmp_path / "page.png")
        with Image.open(tmp_path / "page.png") as image:
            return np.asarray(image.convert("RGB").crop(box), dtype=float)

    for t in (0.0, hatch.time[-1]):
        page.open(file, f"#t={t:.9g}")
        page.value("document.querySelector('.named').click()")
        first = seen(1)
        coloured = hues(first) != "grey"
        assert coloured.sum() > 200
        assert not (coloured[:2].any() or coloured[-2:].any())
        assert not (coloured[:, :2].any() or coloured[:, -2:].any())
    page.value(f"{canvas}.dispatchEvent(new WheelEvent('wheel', {{deltaY: -300}}))")
    assert (seen(2) != first).any()
    page.value("document.querySelector('.reset').click()")
    assert np.array_equal(seen(3), first)


@in_browser
def test_without_webgl(crank, tmp_path):
    """A sentence stands where nothing can be drawn."""
    (_, file), _ = write(crank.path, tmp_path)
    with browser(tmp_path, "--disable-3d-apis") as page:
        page.open(file)
        seen = page.until(f"{SECTION}?.dataset.state == 'no WebGL'",
                          "document.querySelector('.missing').checkVisibility()")  # fmt: skip
    assert seen


def hues(picture):
    """The colour of every pixel in a word; none where it is grey."""
    r, g, b = picture[..., 0], picture[..., 1], picture[..., 2]
    spread = picture.max(axis=-1) - picture.min(axis=-1)
    names = ["grey", "blue", "green", "red", "orange"]
    conditions = [spread < 60, b > np.maximum(r, g) + 20, g > r + 20, (r > 1.6 * g) & (b > 0.7 * g),
                  r > b + 60]  # fmt: skip
    return np.select([*conditions], names, default="grey")
