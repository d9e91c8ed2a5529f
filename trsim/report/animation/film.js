// The .glb of an animation, as trsim writes it: its arrays, its nodes and how they move.

const WIDTHS = { SCALAR: 1, VEC3: 3, VEC4: 4 };
const ARRAYS = { 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array };

const add = (a, b, s = 1) => a.map((x, k) => x + s * b[k]);
const dot = (a, b) => a.reduce((sum, x, k) => sum + x * b[k], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                         a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((x) => x / Math.hypot(...a));
const within = (x, low, high) => Math.min(Math.max(x, low), high);

// --- the file ------------------------------------------------------------------------------

function read(base64) {
  const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
  const view = new DataView(bytes.buffer);
  if (view.getUint32(0, true) !== 0x46546c67) throw new Error("not a .glb");
  const length = view.getUint32(12, true);
  const json = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + length)));
  return { json, begin: 28 + length, buffer: bytes.buffer };
}

function array(file, index) {
  const accessor = file.json.accessors[index];
  const offset = file.begin + (file.json.bufferViews[accessor.bufferView].byteOffset || 0);
  const Kind = ARRAYS[accessor.componentType];
  return new Kind(file.buffer.slice(offset,
    offset + accessor.count * WIDTHS[accessor.type] * Kind.BYTES_PER_ELEMENT));
}

// --- motion --------------------------------------------------------------------------------

function tracks(file) {
  const animation = (file.json.animations || [])[0] || { channels: [], samplers: [] };
  return animation.channels.map((channel) => {
    const sampler = animation.samplers[channel.sampler];
    return { node: file.json.nodes[channel.target.node], path: channel.target.path,
             times: array(file, sampler.input), values: array(file, sampler.output) };
  });
}

function pose(track, t) {
  const { times, values, path, node } = track;
  const width = path === "rotation" ? 4 : 3;
  let low = 0, high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle; else high = middle;
  }
  const s = within((t - times[low]) / (times[high] - times[low] || 1), 0, 1);
  const mixed = [];
  for (let c = 0; c < width; c++)
    mixed.push((1 - s) * values[width * low + c] + s * values[width * high + c]);
  node[path] = path === "rotation" ? unit(mixed) : mixed;
}

function matrix([x, y, z, w]) { // column by column
  return [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w),
          2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w),
          2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)];
}
