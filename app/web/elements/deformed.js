// Draw a solid under its load, visibly deformed and coloured by stress, twist or deflection, with its original edges.
import { facets } from "./facets.js";
import { plain, unit } from "../shared/numbers.js";
import { FIELD, drawScene, rangeOf, showColours } from "../solid/scene.js";

const SHOWN = 0.05; // size of the largest displacement in the drawing, relative to the part
const NOTHING = 0.01; // smaller values, relative to the largest, count as zero
const LINE = { color: "#51606f", width: 2 };

// Scale a surface from the stored load of 1 N·m to another load; all fields are proportional to it.
export function under(surface, load, words) {
  const times = ({ value, unit }) => ({ unit, value: value.map((one) => (Array.isArray(one) ? one.map((part) => part * load) : one * load)) });
  const { displacement, stress, twist } = surface;
  return { ...surface, load: surface.load.replace("1 N*m", words), displacement: times(displacement), stress: times(stress), ...(twist && { twist: times(twist) }) };
}

// The fields that a surface can be coloured by.
export function fieldsOf(surface) {
  const { displacement, stress, twist } = surface;
  const far = displacement.value.map((moved) => Math.hypot(...moved));
  return { stress, ...(twist ? { twist } : { deflection: { value: far, unit: displacement.unit } }) };
}

export async function drawDeformed(place, surface, name) {
  const field = fieldsOf(surface)[name], shown = unit(field.unit);
  const factor = exaggeration(surface);
  const { from, corners, edges } = (surface.facets ??= facets(surface.points.value, surface.triangles));
  const moved = surface.points.value.map((point, n) => point.map((x, axis) => x + factor * surface.displacement.value[n][axis]));
  const { low, high } = coloured(field.value);
  const solid = {
    type: "mesh3d", ...FIELD, cmin: low, cmax: high, ...axes(from.map((point) => moved[point])), i: corners.map(([a]) => a), j: corners.map(([, b]) => b), k: corners.map(([, , c]) => c),
    intensity: from.map((point) => field.value[point]), text: from.map((point) => `${name} ${plain(field.value[point])} ${shown}`), hoverinfo: "text",
  };
  const lines = edges.flatMap((ends) => [...ends.map((point) => surface.points.value[point]), [null, null, null]]);
  const before = { type: "scatter3d", mode: "lines", ...axes(lines), line: LINE, hoverinfo: "skip" };
  if (!place.querySelector(".figure")) place.replaceChildren(node("div", "figure"), node("p", "size muted"));
  showColours(place, { low, high, unit: shown });
  place.querySelector(".size").textContent = `under ${surface.load}; deformation × ${plain(factor)}; lines: undeformed; drag to turn`;
  await drawScene(place.querySelector(".figure"), [solid, before]);
}

// Return the magnification of displacements, with two digits.
function exaggeration({ points, displacement }) {
  const size = Math.max(...[0, 1, 2].map((axis) => width(points.value.map((point) => point[axis]))));
  const most = rangeOf(displacement.value.map((moved) => Math.hypot(...moved))).high;
  return most > 0 ? Number(((SHOWN * size) / most).toPrecision(2)) : 1;
}

// Return the range of the colours; negligible values count as zero.
function coloured(values) {
  const { low, high } = rangeOf(values);
  return { low: Math.abs(low) < NOTHING * high ? 0 : low, high };
}

function width(values) {
  const { low, high } = rangeOf(values);
  return high - low;
}

const axes = (points) => ({ x: points.map(([x]) => x), y: points.map(([, y]) => y), z: points.map(([, , z]) => z) });
const node = (tag, className) => Object.assign(document.createElement(tag), { className });
