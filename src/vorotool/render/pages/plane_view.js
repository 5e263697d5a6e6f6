// points in the plane
const MEASURES = ["regions", "cavities", "area", "perimeter"], EMPTY = {};
const LAYERS = [
  ["triangles", "triangles", true], ["boundary", "boundary edges", true], ["singular", "singular edges", true],
  ["interior", "interior edges", false], ["outside", "outside", false], ["dots", "points", true],
];
const xy = decode(data.xy, Float32Array), POINTS = xy.length / 2;
const edges = decode(data.edges, Int32Array), triangles = decode(data.triangles, Int32Array);
const rankMin = decode(data.rank_min, Int32Array), rankMid = decode(data.rank_mid, Int32Array);
const rankMax = decode(data.rank_max, Int32Array), rankTriangle = decode(data.triangle_rank, Int32Array);

function classOf(edge, count) {
  if (rankMax[edge] < count) return "interior";
  if (rankMin[edge] >= count) return "outside";
  return rankMid[edge] < count ? "boundary" : "singular";
}

function drawPicture(count) {
  const [context, width, height] = cleared(element("picture"));
  const margin = 20, scale = Math.min((width - 2 * margin) / data.width, (height - 2 * margin) / data.height);
  const left = (width - scale * data.width) / 2, top = (height - scale * data.height) / 2;
  const X = i => left + scale * xy[2 * i], Y = i => top + scale * xy[2 * i + 1];
  const counts = { triangles: 0, boundary: 0, singular: 0, interior: 0, outside: 0 };
  context.beginPath();
  for (let t = 0; t < rankTriangle.length; ++t) {
    if (rankTriangle[t] >= count) continue;
    ++counts.triangles;
    const a = triangles[3 * t], b = triangles[3 * t + 1], c = triangles[3 * t + 2];
    context.moveTo(X(a), Y(a)); context.lineTo(X(b), Y(b)); context.lineTo(X(c), Y(c)); context.closePath();
  }
  if (show.triangles) {
    context.fillStyle = context.strokeStyle = color("triangles");
    context.lineWidth = 0.5;
    context.fill(); context.stroke();
  }
  const paths = { outside: new Path2D(), interior: new Path2D(), boundary: new Path2D(), singular: new Path2D() };
  for (let e = 0; e < rankMin.length; ++e) {
    const name = classOf(e, count), path = paths[name];
    ++counts[name];
    path.moveTo(X(edges[2 * e]), Y(edges[2 * e])); path.lineTo(X(edges[2 * e + 1]), Y(edges[2 * e + 1]));
  }
  const spacing = Math.sqrt(width * height / Math.max(1, POINTS));
  for (const name in paths) {
    if (!show[name]) continue;
    context.strokeStyle = color(name);
    context.lineWidth = Math.min(2, Math.max(0.3, spacing / 16)) * (name === "outside" || name === "interior" ? 0.5 : 1);
    context.stroke(paths[name]);
  }
  if (show.dots) {
    const radius = Math.min(3.5, Math.max(0.5, spacing / 12));
    context.fillStyle = color("dots");
    context.beginPath();
    for (let i = 0; i < POINTS; ++i) { context.moveTo(X(i) + radius, Y(i)); context.arc(X(i), Y(i), radius, 0, 7); }
    context.fill();
  }
  return counts;
}
