// What all views in three dimensions have in common: no axes, equal scales, one camera; colours of a field.
import { CONFIG, plotly, scale } from "./plots.js";

const AXES = ["x", "y", "z"];
const DIAGONAL = 2.5; // of the box about a part, in units of which the view shows 2.8: it fits, however it is turned
const ROOM = 1e-3; // of a length, beyond either end of a range: what rounding puts outside of it is not drawn, and a flat end had holes
const HEIGHT = 380; // px, where the place of a view reserves none
const CAMERA = { eye: { x: 1.1, y: -1.3, z: 0.95 }, projection: { type: "orthographic" } };

export const FIELD = { colorscale: "Viridis", showscale: false, lighting: { ambient: 0.9, diffuse: 0.2 } };

let scenes = 1; // Plotly makes their names ids of the page: no two may be alike

// Draw traces; drawn again in the same place, the view stays as it was turned.
export async function drawScene(figure, traces) {
  const Plotly = await plotly();
  const scene = (figure.dataset.scene ??= `scene${++scenes}`);
  const all = traces.map((trace) => ({ ...trace, scene }));
  const height = reserved(figure.parentElement), upright = Math.min(1, figure.parentElement.clientWidth / height || 1); // a narrow view shows less
  await Plotly.react(figure, all, { height, margin: { l: 0, r: 0, t: 0, b: 0 }, paper_bgcolor: "rgba(0,0,0,0)", uirevision: "kept", showlegend: false, [scene]: { ...box(traces, upright), camera: CAMERA } }, CONFIG);
}

// The height that a style reserves for a view before it is drawn.
function reserved(place) {
  return Math.round(parseFloat(getComputedStyle(place).minHeight)) || HEIGHT;
}

// The box about all traces, as large as fits into a view of which the width is so many times the height, at most once.
function box(traces, upright) {
  const ranges = AXES.map((axis) => rangeOf(traces.flatMap((trace) => Array.from(trace[axis])).filter((value) => value !== null)));
  const lengths = ranges.map(({ low, high }) => high - low), unit = (DIAGONAL * upright) / Math.hypot(...lengths);
  const hidden = ({ low, high }) => ({ visible: false, showbackground: false, range: [low - ROOM * (high - low), high + ROOM * (high - low)] });
  const [xaxis, yaxis, zaxis] = ranges.map(hidden), [x, y, z] = lengths.map((length) => length * unit);
  return { aspectmode: "manual", aspectratio: { x, y, z }, xaxis, yaxis, zaxis };
}

export function rangeOf(values) {
  return values.reduce(({ low, high }, value) => ({ low: Math.min(low, value), high: Math.max(high, value) }), { low: Infinity, high: -Infinity });
}

// The colours of a field below its view, in the place of those of the field before; none, if there is no field.
export function showColours(place, field) {
  place.querySelector(".colours")?.remove();
  if (field) place.append(scale(field.low, field.high, field.unit));
}
