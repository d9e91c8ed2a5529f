// Plays the animation of every section of class "animation" in the page.  WebGL 1, nothing from
// outside.  Follows film.js in the same function.

const VERTEX = `
  attribute vec3 place, normal;
  uniform mat4 project; uniform mat3 turn; uniform vec3 shift, size;
  varying vec3 n, p;
  void main() {
    p = turn * (size * place) + shift;
    n = turn * (normal / size);
    gl_Position = project * vec4(p, 1.0);
  }`;
// light from over the shoulder of who looks, from the sky, and a little gloss
const FRAGMENT = `
  precision mediump float;
  uniform vec3 colour, eye, up, lamp;
  varying vec3 n, p;
  void main() {
    vec3 m = normalize(n), v = normalize(eye - p), l = normalize(lamp);
    float sky = 0.5 + 0.5 * dot(m, up), gloss = pow(max(dot(m, normalize(l + v)), 0.0), 40.0);
    vec3 c = colour * (0.28 + 0.27 * sky + 0.62 * max(dot(m, l), 0.0)) + 0.10 * gloss;
    gl_FragColor = vec4(pow(c, vec3(1.0 / 2.2)), 1.0);
  }`;
const OPENING = 0.42; // rad, of the picture from below to above

// --- who looks -----------------------------------------------------------------------------

// A flat mechanism is seen along its normal and a little aside, one in space as the file says: then
// the box whose middle is looked at stands as who looks does.
function camera({ outermost, margin, normal, up: sky, back }) {
  const front = unit(normal || add(back, sky, -dot(back, sky)));
  const up = sky || (Math.abs(front[1]) > 0.9 ? [0, 0, 1]
                                              : unit(add([0, 1, 0], front, -front[1])));
  const right = cross(up, front);
  const axes = normal ? [[1, 0, 0], [0, 1, 0], [0, 0, 1]] : [right, cross(back, right), back];
  const most = (pick) => axes.map((axis) => pick(...outermost.map((p) => dot(p, axis))));
  const low = most(Math.min), high = most(Math.max);
  const at = axes.reduce((sum, axis, k) => add(sum, axis, (low[k] + high[k]) / 2), [0, 0, 0]);
  const points = outermost.map((p) => add(p, at, -1));
  const aside = normal ? { yaw: 0.25, pitch: 0.16 } : { yaw: 0, pitch: Math.asin(dot(back, up)) };
  const first = { ...aside, zoom: 1, at };
  const size = Math.hypot(...add(high, low, -1)) / 2 + margin;
  const look = { ...first, up, right, front, points, margin, size };
  look.reset = () => Object.assign(look, first);
  return look;
}

// directions to the right, upwards and to who looks; the eye; the product of both matrices
function sight(look, aspect) {
  const { yaw, pitch, margin, size } = look;
  const level = add(look.front.map((x) => x * Math.cos(yaw)), look.right, Math.sin(yaw));
  const back = add(level.map((x) => x * Math.cos(pitch)), look.up, Math.sin(pitch));
  const right = unit(cross(look.up, back)), up = cross(back, right);
  const tangent = Math.tan(OPENING / 2);
  // so far away that every point is in the picture
  const distance = Math.max(...look.points.map((p) => dot(p, back) + 1.06 / tangent * Math.max(
    Math.abs(dot(p, up)) + margin, (Math.abs(dot(p, right)) + margin) / aspect))) / look.zoom;
  const eye = add(look.at, back, distance);
  const near = Math.max(distance - 6 * size, 0.01 * distance), far = distance + 6 * size;
  const a = (far + near) / (near - far), b = 2 * far * near / (near - far);
  const f = 1 / tangent, rows = [right, up, back];
  const moved = rows.map((row) => -dot(row, eye));
  const project = [];
  for (let c = 0; c < 3; c++)
    project.push(f / aspect * right[c], f * up[c], a * back[c], -back[c]);
  project.push(f / aspect * moved[0], f * moved[1], a * moved[2] + b, -moved[2]);
  return { project, eye, right, up, back, perPixel: 2 * distance * tangent };
}

function handle(canvas, look, changed) {
  const fingers = new Map();
  const drag = (dx, dy, pan) => {
    if (pan) {
      const seen = sight(look, canvas.width / canvas.height);
      const scale = seen.perPixel / canvas.clientHeight;
      look.at = add(add(look.at, seen.right, -dx * scale), seen.up, dy * scale);
    } else {
      look.yaw -= 0.008 * dx;
      look.pitch = within(look.pitch + 0.008 * dy, -1.55, 1.55);
    }
  };
  const zoom = (factor) => { look.zoom = within(look.zoom * factor, 0.2, 200); changed(); };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const now = [event.clientX, event.clientY];
    const other = [...fingers].find(([id]) => id !== event.pointerId);
    const share = other ? 0.5 : 1; // two fingers move together: each tells half of it
    drag(share * (now[0] - before[0]), share * (now[1] - before[1]),
         other || event.shiftKey || event.buttons > 1);
    if (other) zoom(Math.hypot(...add(now, other[1], -1)) /
                    Math.max(Math.hypot(...add(before, other[1], -1)), 1));
    fingers.set(event.pointerId, now);
    changed();
  });
  for (const end of ["pointerup", "pointercancel"])
    canvas.addEventListener(end, (event) => fingers.delete(event.pointerId));
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom(Math.exp(-0.0015 * event.deltaY));
  }, { passive: false });
  canvas.addEventListener("dblclick", () => { look.reset(); changed(); });
}

// --- drawing -------------------------------------------------------------------------------

function program(gl) {
  const made = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
  const where = (name) => gl.getUniformLocation(made, name);
  const names = ["project", "turn", "shift", "size", "colour", "eye", "up", "lamp"];
  return { made, place: gl.getAttribLocation(made, "place"),
           normal: gl.getAttribLocation(made, "normal"),
           ...Object.fromEntries(names.map((name) => [name, where(name)])) };
}

function uploaded(gl, file) {
  const kept = {}; // accessor -> buffer
  const buffer = (target, index) => {
    if (!kept[index]) {
      kept[index] = gl.createBuffer();
      gl.bindBuffer(target, kept[index]);
      gl.bufferData(target, array(file, index), gl.STATIC_DRAW);
    }
    return kept[index];
  };
  gl.getExtension("OES_element_index_uint");
  return file.json.meshes.map((mesh) => mesh.primitives.map((part) => ({
    place: buffer(gl.ARRAY_BUFFER, part.attributes.POSITION),
    normal: buffer(gl.ARRAY_BUFFER, part.attributes.NORMAL),
    corners: buffer(gl.ELEMENT_ARRAY_BUFFER, part.indices),
    kind: file.json.accessors[part.indices].componentType,
    count: file.json.accessors[part.indices].count,
    colour: file.json.materials[part.material].pbrMetallicRoughness.baseColorFactor.slice(0, 3),
  })));
}

function paint(gl, shader, meshes, nodes, seen) {
  gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  gl.uniformMatrix4fv(shader.project, false, seen.project);
  gl.uniform3fv(shader.eye, seen.eye);
  gl.uniform3fv(shader.up, seen.up);
  gl.uniform3fv(shader.lamp, add(add(seen.back, seen.up, 0.7), seen.right, -0.5));
  for (const node of nodes) {
    const size = node.scale || [1, 1, 1];
    if (Math.min(...size.map(Math.abs)) < 1e-9) continue; // an arrow without a force
    gl.uniform3fv(shader.size, size);
    gl.uniform3fv(shader.shift, node.translation || [0, 0, 0]);
    gl.uniformMatrix3fv(shader.turn, false, matrix(node.rotation || [0, 0, 0, 1]));
    for (const part of meshes[node.mesh]) {
      gl.uniform3fv(shader.colour, part.colour);
      for (const name of ["place", "normal"]) {
        gl.bindBuffer(gl.ARRAY_BUFFER, part[name]);
        gl.vertexAttribPointer(shader[name], 3, gl.FLOAT, false, 0, 0);
      }
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, part.corners);
      gl.drawElements(gl.TRIANGLES, part.count, part.kind, 0);
    }
  }
}

function begun(gl, file) {
  const shader = program(gl);
  gl.useProgram(shader.made);
  gl.enableVertexAttribArray(shader.place);
  gl.enableVertexAttribArray(shader.normal);
  gl.enable(gl.DEPTH_TEST);
  gl.enable(gl.CULL_FACE);
  gl.clearColor(0, 0, 0, 0);
  return { shader, meshes: uploaded(gl, file) };
}

// names beside the joints
function write(labels, seen, shown) {
  for (const { span, node } of labels) {
    const [x, y, z] = node.translation, m = seen.project;
    const at = [0, 1, 3].map((r) => m[r] * x + m[4 + r] * y + m[8 + r] * z + m[12 + r]);
    span.hidden = !shown || at[2] <= 0;
    span.style.left = `${50 + 50 * at[0] / at[2]}%`;
    span.style.top = `${50 - 50 * at[1] / at[2]}%`;
  }
}

// --- a section of the page -----------------------------------------------------------------

function speeds(select, duration) {
  const wanted = duration / 6; // a run is seen in six seconds or a little more
  const power = Math.pow(10, Math.floor(Math.log10(wanted)));
  const usual = [5, 2, 1].find((m) => m * power <= wanted * 1.0001) * power || 1;
  for (const factor of [0.02, 0.1, 0.2, 0.5, 1, 2, 5]) {
    const speed = Number((usual * factor).toPrecision(1));
    const words = speed < 1 ? `1/${Number((1 / speed).toPrecision(3))}` : `${speed} \u00d7`;
    select.add(new Option(speed === 1 ? "real time" : `${words} real time`, String(speed),
                          factor === 1, factor === 1));
  }
}

function show(section) {
  const find = (name) => section.querySelector(name);
  const canvas = find("canvas"), slider = find(".time"), clock = find(".clock");
  const file = read(find(".glb").textContent.trim());
  const gl = canvas.getContext("webgl", { antialias: true });
  if (!gl) { section.dataset.state = "no WebGL"; return; }
  const moving = tracks(file), nodes = file.json.nodes;
  const duration = moving.reduce((most, track) => Math.max(most, track.times.at(-1)), 0);
  const start = Number(section.dataset.start), look = camera(file.json.scenes[0].extras);
  const digits = Math.max(2, 4 - Math.floor(Math.log10(duration || 1)));
  let drawing = begun(gl, file), now = 0, last = null, stale = true, playing = duration > 0;
  const labels = nodes.filter((node) => node.extras && node.extras.label).map((node) => {
    const span = find(".names").appendChild(document.createElement("span"));
    span.textContent = node.extras.label;
    return { span, node };
  });
  const changed = () => { stale = true; };
  const play = (on) => {
    playing = on && duration > 0;
    find(".play").textContent = playing ? "Pause" : "Play";
    last = null;
  };
  const seek = (t) => { now = within(t, 0, duration); stale = true; };
  const asked = /[#&]t=([-+.\de]+)/.exec(location.hash);
  if (asked) seek(Number(asked[1]) - start);
  play(!asked && !matchMedia("(prefers-reduced-motion: reduce)").matches);
  speeds(find(".speed"), duration || 1);
  handle(canvas, look, changed);
  find(".play").addEventListener("click", () => play(!playing));
  find(".reset").addEventListener("click", () => { look.reset(); changed(); });
  find(".named").addEventListener("change", changed);
  slider.addEventListener("input", () => { play(false); seek(slider.value * duration); });
  new ResizeObserver(changed).observe(canvas);
  canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
  canvas.addEventListener("webglcontextrestored", () => { drawing = begun(gl, file); changed(); });
  section.dataset.state = "ready";

  function frame(clockTime) {
    if (playing && last !== null) {
      const ahead = now + (clockTime - last) / 1000 * Number(find(".speed").value);
      seek(ahead > duration ? 0 : ahead);
    }
    last = clockTime;
    if (stale && !gl.isContextLost()) {
      const scale = Math.min(devicePixelRatio || 1, 2);
      const wide = Math.round(canvas.clientWidth * scale);
      const high = Math.round(canvas.clientHeight * scale);
      if (canvas.width !== wide) canvas.width = wide;
      if (canvas.height !== high) canvas.height = high;
      moving.forEach((track) => pose(track, now));
      const seen = sight(look, wide / Math.max(high, 1));
      paint(gl, drawing.shader, drawing.meshes, nodes, seen);
      write(labels, seen, find(".named").checked);
      slider.value = duration ? now / duration : 0;
      clock.textContent = `t = ${(start + now).toFixed(digits)} s`;
      section.dataset.time = String(start + now);
      section.dataset.drawn = String(Number(section.dataset.drawn || 0) + 1);
      stale = false;
    }
    requestAnimationFrame(frame);
  }
  requestAnimationFrame(frame);
}

for (const section of document.querySelectorAll("section.animation:not([data-state])")) {
  section.dataset.state = "starting";
  try {
    show(section);
  } catch (error) {
    section.dataset.state = `failed: ${error.message}`;
  }
}
