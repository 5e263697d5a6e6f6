// points in space, as seen from far away; z goes upwards
const MEASURES = Object.keys(data.curves), EMPTY = { parts: data.distinct };
const places = decode(data.places, Float32Array), POINTS = places.length / 3;
const triangles = decode(data.triangles, Uint32Array), edges = decode(data.edges, Uint32Array);
const faceMin = decode(data.triangle_min, Int32Array), faceMid = decode(data.triangle_mid, Int32Array);
const faceMax = decode(data.triangle_max, Int32Array), edgeMin = decode(data.edge_min, Int32Array);
const edgeMid = decode(data.edge_mid, Int32Array), edgeMax = decode(data.edge_max, Int32Array);
const pointMin = decode(data.point_min, Int32Array), always = new Int32Array(POINTS).fill(-1);
const indices = Uint32Array.from(pointMin, (_, k) => k);
const LAYERS = MEASURES.length ? [
  ["surface", "surface", true], ["faces", "singular triangles", true], ["singular", "singular edges", true],
  ["isolated", "isolated points", true], ["edges", "edges of triangles", false], ["dots", "all points", POINTS <= 1000],
] : [
  ["surface", "hull", true], ["edges", "edges of the hull", true], ["interior", "edges inside", !triangles.length],
  ["dots", "points", POINTS <= 1000],
];
const SIZES = { surface: 3, faces: 3, singular: 2, edges: 2, interior: 2, isolated: 1, dots: 1 };
const canvas = element("picture");
const HOME = { around: Math.atan2(-3, 2), above: Math.asin(2 / Math.sqrt(17)), zoom: 1, x: 0, y: 0 };
let eye = { ...HOME }, isWaiting = false;

const TURNED = `#version 300 es
  precision highp float;
  uniform mat3 turn;  // rows: to the right, upwards, to the viewer
  uniform vec2 scale, shift, pixel;
  uniform float nearer, width;
  vec4 shown(vec3 at) { return vec4(at.xy * scale + shift, (-at.z - nearer) * 0.45, 1.0); }
`;
const FILLED = `#version 300 es
  precision highp float;
  uniform vec3 tint;
  out vec4 ink;
`;
const PROGRAMS = {
  faces: [`${TURNED} layout(location=0) in vec3 place; out vec3 seen;
    void main() { seen = turn * place; gl_Position = shown(seen); }`, `${FILLED} in vec3 seen; uniform vec3 light;
    void main() {
      vec3 normal = cross(dFdx(seen), dFdy(seen));
      normal *= (normal.z < 0.0 ? -1.0 : 1.0) / max(length(normal), 1e-30);
      ink = vec4(tint * (0.35 + 0.65 * clamp(dot(normal, light), 0.0, 1.0)), 1.0);
    }`],
  lines: [`${TURNED} layout(location=0) in vec3 start; layout(location=1) in vec3 end;
    void main() {
      vec3 a = turn * start, b = turn * end, at = (gl_VertexID & 1) == 0 ? a : b;
      vec2 along = (b.xy - a.xy) * scale / pixel;
      along = length(along) > 1e-9 ? normalize(along) : vec2(1.0, 0.0);
      vec2 aside = vec2(-along.y, along.x) * (gl_VertexID < 2 ? -0.5 : 0.5) * width;
      gl_Position = shown(at) + vec4(aside * pixel, 0.0, 0.0);
    }`, `${FILLED} void main() { ink = vec4(tint, 1.0); }`],
  dots: [`${TURNED} layout(location=0) in vec3 place;
    void main() { gl_Position = shown(turn * place); gl_PointSize = width + 1.0; }`, `${FILLED} uniform float width;
    void main() {
      float within = (width * 0.5 + 0.5) - length(gl_PointCoord - 0.5) * (width + 1.0);
      if (within <= 0.0) discard;
      ink = vec4(tint, min(within, 1.0));
    }`],
};

function compiled([vertex, fragment]) {
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  const of = new Proxy({}, { get: (_, name) => gl.getUniformLocation(program, name) });
  return { program, of };
}

const buffers = {}, programs = {}, drawn = {};
let gl = canvas.getContext("webgl2", { alpha: false, antialias: true });
try {
  for (const name in gl && PROGRAMS) programs[name] = compiled(PROGRAMS[name]);
} catch (error) {
  console.error(error);
  gl = null;
}
if (gl) {
  for (const name of ["places", ...LAYERS.map(layer => layer[0])]) buffers[name] = gl.createBuffer();
  gl.bindBuffer(gl.ARRAY_BUFFER, buffers.places);
  gl.bufferData(gl.ARRAY_BUFFER, places, gl.STATIC_DRAW);
  gl.enable(gl.DEPTH_TEST);
  gl.enable(gl.POLYGON_OFFSET_FILL);
} else {
  element("missing").textContent = "The picture needs WebGL 2, which this browser lacks or has switched off. All numbers are right without it.";
  element("missing").hidden = false;
  canvas.hidden = true;
}

// the corners of the simplices that are there from a rank on until another one is reached
function chosen(corners, size, from, until, count) {
  let found = 0, to = 0;
  for (let k = 0; k < from.length; ++k) found += from[k] < count && count <= until[k];
  const rows = new Uint32Array(size * found);
  for (let k = 0; k < from.length; ++k) {
    if (from[k] < count && count <= until[k]) for (let i = 0; i < size; ++i) rows[to++] = corners[size * k + i];
  }
  return rows;
}

function drawPicture(count) {
  const rows = {
    surface: () => chosen(triangles, 3, faceMid, faceMax, count),
    faces: () => chosen(triangles, 3, faceMin, faceMid, count),
    singular: () => chosen(edges, 2, edgeMin, edgeMid, count),
    interior: () => chosen(edges, 2, edgeMin, edgeMid, count),
    edges: () => chosen(edges, 2, edgeMid, edgeMax, count),
    isolated: () => chosen(indices, 1, always, pointMin, count),
    dots: () => indices,
  };
  const counts = {};
  for (const [name] of LAYERS) {
    const own = rows[name]();
    counts[name] = own.length / SIZES[name];
    if (gl) fill(name, own);
  }
  redraw();
  return counts;
}

// triangles share the places of points; lines and dots have those of their ends
function fill(name, rows) {
  const isFace = SIZES[name] === 3, target = isFace ? gl.ELEMENT_ARRAY_BUFFER : gl.ARRAY_BUFFER;
  drawn[name] = show[name] ? rows.length / SIZES[name] : 0;
  if (!drawn[name]) return;
  const values = isFace ? rows : new Float32Array(3 * rows.length);
  if (!isFace) rows.forEach((row, k) => { for (let i = 0; i < 3; ++i) values[3 * k + i] = places[3 * row + i]; });
  gl.bindBuffer(target, buffers[name]);
  gl.bufferData(target, values, gl.DYNAMIC_DRAW);
}

function redraw() {
  if (!gl || isWaiting) return;
  isWaiting = true;
  requestAnimationFrame(() => { isWaiting = false; paint(); });
}

const tone = name => [1, 3, 5].map(k => parseInt(color(name).slice(k, k + 2), 16) / 255);

// the directions to the right, upwards and to the viewer
function axes({ around, above }) {
  const [c, s, C, S] = [Math.cos(around), Math.sin(around), Math.cos(above), Math.sin(above)];
  return [[-s, c, 0], [-S * c, -S * s, C], [C * c, C * s, S]];
}

const light = axes(HOME).map(axis => (axis[0] - 2 * axis[1] + 2 * axis[2]) / 3);  // stays with the viewer
const half = (width, height) => Math.max(1, Math.min(width, height) / 2 - 20);

function paint() {
  const [ratio, width, height] = sized(canvas), across = half(width, height) * eye.zoom, turn = axes(eye);
  const spacing = Math.sqrt(width * height / Math.max(1, POINTS)) * eye.zoom;
  const wide = { edges: Math.min(1, Math.max(0.3, spacing / 24)), interior: 0.7, singular: 1.5, isolated: 5, dots: Math.min(6, Math.max(1, spacing / 8)) };
  gl.viewport(0, 0, canvas.width, canvas.height);
  gl.clearColor(...tone("ground"), 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  for (const [name] of LAYERS) {
    if (!drawn[name]) continue;
    const kind = ["dots", "lines", "faces"][SIZES[name] - 1], { program, of } = programs[kind];
    const size = kind === "dots" ? wide[name] * ratio : wide[name];
    gl.useProgram(program);
    gl.polygonOffset(...(kind === "faces" ? [1.5, 2] : [0, 0]));  // lines are before the faces that they bound
    gl.uniformMatrix3fv(of.turn, false, [0, 1, 2].flatMap(k => turn.map(axis => axis[k])));
    gl.uniform2f(of.scale, 2 * across / width, 2 * across / height);
    gl.uniform2f(of.shift, 2 * eye.x / width, -2 * eye.y / height);
    gl.uniform2f(of.pixel, 2 / width, 2 / height);
    gl.uniform1f(of.nearer, kind === "dots" ? 0.5 * wide[name] / across : 0);
    gl.uniform1f(of.width, size);
    gl.uniform3fv(of.tint, tone(name));
    gl.uniform3fv(of.light, light);
    SENT[kind](name);
  }
}

function bind(buffer, location, stride, offset, every) {
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.enableVertexAttribArray(location);
  gl.vertexAttribPointer(location, 3, gl.FLOAT, false, stride, offset);
  gl.vertexAttribDivisor(location, every);
}

const SENT = {
  faces(name) {
    bind(buffers.places, 0, 12, 0, 0);
    gl.disableVertexAttribArray(1);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffers[name]);
    gl.drawElements(gl.TRIANGLES, 3 * drawn[name], gl.UNSIGNED_INT, 0);
  },
  lines(name) {
    bind(buffers[name], 0, 24, 0, 1);
    bind(buffers[name], 1, 24, 12, 1);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, drawn[name]);
  },
  dots(name) {
    bind(buffers[name], 0, 12, 0, 0);
    gl.disableVertexAttribArray(1);
    gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE);
    gl.drawArrays(gl.POINTS, 0, drawn[name]);
    gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE);
  },
};

// ---- the viewer moves
function move(x, y) {
  eye.x += x;
  eye.y += y;
  redraw();
}

function turnBy(x, y) {
  const box = canvas.getBoundingClientRect(), across = half(box.width, box.height);
  eye.around -= x / across;
  eye.above = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, eye.above + y / across));
  redraw();
}

// what is seen at a place, in pixels from the middle, stays there
function zoomBy(factor, x = 0, y = 0) {
  const zoom = Math.min(200, Math.max(0.1, eye.zoom * factor)), by = zoom / eye.zoom;
  eye = { ...eye, zoom, x: x - (x - eye.x) * by, y: y - (y - eye.y) * by };
  redraw();
}

function reset() {
  eye = { ...HOME };
  redraw();
}

const fromMiddle = event => {
  const box = canvas.getBoundingClientRect();
  return [event.clientX - box.left - box.width / 2, event.clientY - box.top - box.height / 2];
};
const fingers = new Map();
function grip() {
  const [a, b = a] = fingers.values();
  return { x: (a[0] + b[0]) / 2, y: (a[1] + b[1]) / 2, span: Math.hypot(a[0] - b[0], a[1] - b[1]) };
}

canvas.addEventListener("pointerdown", event => {
  canvas.setPointerCapture(event.pointerId);
  fingers.set(event.pointerId, fromMiddle(event));
});
canvas.addEventListener("pointermove", event => {
  if (!fingers.has(event.pointerId)) return;
  const old = grip();
  fingers.set(event.pointerId, fromMiddle(event));
  const now = grip(), by = [now.x - old.x, now.y - old.y];
  if (fingers.size === 1 && !event.shiftKey) return turnBy(...by);
  move(...by);
  if (old.span && now.span) zoomBy(now.span / old.span, now.x, now.y);
});
for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, event => fingers.delete(event.pointerId));
canvas.addEventListener("wheel", event => {
  event.preventDefault();
  zoomBy(Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.002)), ...fromMiddle(event));
}, { passive: false });
const WAYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
canvas.addEventListener("keydown", event => {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  const way = WAYS[event.key], factor = { "+": 1.2, "=": 1.2, "-": 1 / 1.2 }[event.key];
  if (way) (event.shiftKey ? move : turnBy)(30 * way[0], 30 * way[1]);
  else if (factor) zoomBy(factor);
  else if (event.key === "0" || event.key === "Home") reset();
  else return;
  event.preventDefault();
});
canvas.addEventListener("webglcontextlost", event => event.preventDefault());
canvas.addEventListener("webglcontextrestored", () => location.reload());
canvas.tabIndex = 0;
canvas.style.cssText = "touch-action: none; cursor: grab";
canvas.setAttribute("role", "application");
canvas.setAttribute("aria-label", "picture in space: arrow keys turn it, with shift they move it, + and - zoom, 0 resets");
const button = document.createElement("button");
button.textContent = "reset the view";
button.addEventListener("click", reset);
element("help").append(button, " Drag or arrow keys: turn; wheel, pinch, + or −: zoom; shift: move; 0: reset.");
