"""The animation in a page: canvas, controls, legend, the .glb in base64, and the viewer.

Nothing is asked of the network; the stand-alone page forbids it.
"""

import base64
from html import escape
from pathlib import Path

from trsim.report.animation.reel import Film
from trsim.report.animation.things import FORCE, JOURNAL

SCRIPTS = "film.js", "viewer.js"
POLICY = (
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "base-uri 'none'; form-action 'none'"
)

STYLE = """
.animation { font: 15px/1.45 "DejaVu Sans", Verdana, Helvetica, Arial, sans-serif;
  color: #1a1a1a; margin: 1.5rem 0; }
.animation .stage { position: relative; height: 34rem; max-height: 80vh; overflow: hidden;
  border: 1px solid #cfd4da; border-radius: 6px;
  background: linear-gradient(#fbfcfd, #e4e8ed); }
.animation canvas { width: 100%; height: 100%; display: block; object-fit: contain;
  touch-action: none; cursor: grab; }
.animation canvas:active { cursor: grabbing; }
.animation .names { position: absolute; inset: 0; pointer-events: none; }
.animation .names span { position: absolute; transform: translate(14px, -24px); font-size: .8rem;
  padding: 0 .3em; border-radius: 3px; background: rgba(255, 255, 255, .75); }
.animation .controls { display: flex; flex-wrap: wrap; align-items: center; gap: .6rem;
  padding: .6rem 0; }
.animation .controls .time { flex: 1 1 12rem; min-width: 8rem; }
.animation .clock { font-variant-numeric: tabular-nums; min-width: 8.5em; text-align: right; }
.animation button, .animation select { font: inherit; padding: .15rem .6rem; }
.animation .play { min-width: 5.2em; }
.animation ul { list-style: none; display: flex; flex-wrap: wrap; gap: .2rem 1.2rem; margin: 0;
  padding: 0; }
.animation li i { display: inline-block; width: .8em; height: .8em; border-radius: 2px;
  margin-right: .4em; }
.animation p { font-size: .85rem; color: #444; margin: .5rem 0; max-width: 60rem; }
.animation .missing { display: none; position: absolute; inset: 0; padding: 2rem; }
.animation[data-state^="no"] .missing, .animation[data-state^="failed"] .missing,
.animation:not([data-state]) .missing { display: block; }
"""

WHOLE_STYLE = """
body { margin: 0 auto; padding: 0 1rem; max-width: 90rem; background: #fff; }
h1 { font: bold 1.3rem/1.3 "DejaVu Sans", Verdana, Helvetica, Arial, sans-serif;
  margin: 1rem 0 0; }
.animation { margin: .7rem 0; }
.animation .stage { height: calc(100vh - 15.5rem); min-height: 20rem; max-height: none; }
"""

MISSING = (
    "This browser shows no animation: it has no WebGL, or runs no scripts. "
    "animation.glb holds the same for other programs."
)


def part(film: Film) -> str:
    """A section that can stand in any page."""
    here = Path(__file__).parent
    viewer = "\n".join((here / name).read_text(encoding="utf-8") for name in SCRIPTS)
    data = base64.b64encode(film.glb).decode()
    return f"""<section class="animation" data-start="{film.start!r}">
<style>{STYLE}</style>
<div class="stage"><canvas role="img" aria-label="Animation of {escape(film.title)}"></canvas>
<div class="names"></div><p class="missing">{MISSING}</p></div>
<div class="controls"><button type="button" class="play">Play</button>
<input type="range" class="time" min="0" max="1" step="any" value="0" aria-label="time">
<output class="clock"></output><select class="speed" aria-label="speed"></select>
<label><input type="checkbox" class="named" checked> names</label>
<button type="button" class="reset">Reset view</button></div>
{legend(film)}
<script type="text/plain" class="glb">{data}</script>
<script>
(() => {{
"use strict";
{viewer}}})();
</script>
</section>
"""


def whole(film: Film) -> str:
    """A page that stands alone."""
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="generator" content="trsim">
<meta http-equiv="Content-Security-Policy" content="{POLICY}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(film.title)}</title>
<style>{WHOLE_STYLE}</style>
</head>
<body>
<h1>{escape(film.title)}</h1>
{part(film)}</body>
</html>
"""


def legend(film: Film) -> str:
    """Bodies and their colours, the scale of the arrows, what was magnified, warnings."""
    entries = [(colour, name.replace("_", " ")) for name, colour in film.colours.items()]
    if film.magnified > 1.0:
        entries.append((JOURNAL, f"journals, their clearance drawn {film.magnified:g} times"))
    if film.scale:
        entries.append((FORCE, f"contact forces, {arrow_scale(film.scale)}"))
    items = "".join(f'<li><i style="background:{c}"></i>{escape(text)}</li>' for c, text in entries)
    told = []
    if film.scale:
        told.append(
            "Arrows point to the contact; each is the largest force since the frame before, "
            "as it acts on the second body of the joint or stop."
        )
    if film.magnified > 1.0:
        told.append("Only the play in the bearings is magnified: the bodies are where they were.")
    told.append("Drag to turn, with Shift or two fingers to move, wheel or pinch to zoom.")
    warned = "".join(f"<p><strong>Warning:</strong> {escape(text)}.</p>" for text in film.warnings)
    return f"<ul>{items}</ul>{warned}<p>{' '.join(told)}</p>"


def arrow_scale(scale: float) -> str:
    """The scale of arrows in words: 1 kN is 100 mm."""
    newtons = 1.0
    while scale * newtons < 0.03:
        newtons *= 10.0
    force = f"{newtons / 1e3:g} kN" if newtons >= 1e3 else f"{newtons:g} N"
    return f"{force} is {1e3 * scale * newtons:g} mm"
