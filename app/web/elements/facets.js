// Prepare triangles between shared points for drawing: sharp at the edges of the surface, smooth elsewhere.
const EDGE = Math.cos((35 * Math.PI) / 180);

// Return each point once for each of its sides (`from` is the original point), and all sharp edges.
export function facets(points, triangles) {
  const normals = triangles.map(([a, b, c]) => normal(points[a], points[b], points[c]));
  const sides = points.map(() => []), from = [];
  const corners = triangles.map((triangle, t) => triangle.map((point) => {
    let side = sides[point].find(({ along }) => dot(along, normals[t]) > EDGE);
    if (!side) sides[point].push((side = { number: from.push(point) - 1, along: normals[t] }));
    return side.number;
  }));
  return { from, corners, edges: sharp(triangles, normals) };
}

function sharp(triangles, normals) {
  const first = new Map(), edges = [];
  triangles.forEach((triangle, t) => triangle.forEach((start, n) => {
    const end = triangle[(n + 1) % 3], key = start < end ? `${start} ${end}` : `${end} ${start}`;
    if (!first.has(key)) first.set(key, t);
    else if (dot(normals[first.get(key)], normals[t]) < EDGE) edges.push([start, end]);
  }));
  return edges;
}

function normal(a, b, c) {
  const [p, q] = [b, c].map((corner) => corner.map((x, n) => x - a[n]));
  const across = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
  const length = Math.hypot(...across) || 1;
  return across.map((x) => x / length);
}

const dot = (one, other) => one[0] * other[0] + one[1] * other[1] + one[2] * other[2];
