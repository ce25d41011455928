// Settings that all 3-D views share: no axes, equal scales, one camera; colours of a field.
import { CONFIG, plotly, scale } from "../plots/plots.js";

const AXES = ["x", "y", "z"];
const DIAGONAL = 2.5; // largest size of the box around a part, in units of the view
const FILLED = 0.96; // share of the view's height or width that the part fills at first
const ROOM = 1e-3; // margin at both ends of a range, relative to its length, so that rounding does not cut holes into flat ends
const HEIGHT = 380; // default height of a view [px]
const EYE = { x: 1.1, y: -1.3, z: 0.95 }, CAMERA = { eye: EYE, projection: { type: "orthographic" } };
const LEVEL = Math.hypot(EYE.x, EYE.y), SHOWN = Math.hypot(LEVEL, EYE.z); // height of an orthographic view [units]
const RIGHT = [-EYE.y / LEVEL, EYE.x / LEVEL, 0], UP = [(-EYE.z * EYE.x) / LEVEL / SHOWN, (-EYE.z * EYE.y) / LEVEL / SHOWN, LEVEL / SHOWN];

export const FIELD = { colorscale: "Viridis", showscale: false, lighting: { ambient: 0.9, diffuse: 0.2 } };

let scenes = 1; // Plotly uses their names as ids on the page, so they must be distinct

// Draw traces; if they are drawn again in the same place, the view keeps its orientation.
export async function drawScene(figure, traces) {
  const Plotly = await plotly();
  const scene = (figure.dataset.scene ??= `scene${++scenes}`);
  const all = traces.map((trace) => ({ ...trace, scene }));
  const height = reserved(figure.parentElement), wide = figure.parentElement.clientWidth / height || 1;
  await Plotly.react(figure, all, { height, margin: { l: 0, r: 0, t: 0, b: 0 }, paper_bgcolor: "rgba(0,0,0,0)", uirevision: "kept", showlegend: false, [scene]: { ...box(traces, wide), camera: CAMERA } }, CONFIG);
}

// Return the height that a style reserves for a view before it is drawn.
function reserved(place) {
  return Math.round(parseFloat(getComputedStyle(place).minHeight)) || HEIGHT;
}

// Return the box around all traces, as large as fits into a view with this ratio of width to height.
function box(traces, wide) {
  const ranges = AXES.map((axis) => rangeOf(traces.flatMap((trace) => Array.from(trace[axis])).filter((value) => value !== null)));
  const lengths = ranges.map(({ low, high }) => high - low), middle = ranges.map(({ low, high }) => (low + high) / 2);
  const across = reach(traces, middle, RIGHT), upright = reach(traces, middle, UP);
  const unit = Math.min(DIAGONAL / Math.hypot(...lengths), (FILLED * SHOWN) / upright, (FILLED * SHOWN * wide) / across);
  const hidden = ({ low, high }) => ({ visible: false, showbackground: false, range: [low - ROOM * (high - low), high + ROOM * (high - low)] });
  const [xaxis, yaxis, zaxis] = ranges.map(hidden), [x, y, z] = lengths.map((length) => length * unit);
  return { aspectmode: "manual", aspectratio: { x, y, z }, xaxis, yaxis, zaxis };
}

// Return twice the largest distance of points from the middle along a direction.
function reach(traces, [x, y, z], [u, v, w]) {
  let most = 0;
  for (const trace of traces.filter(({ type }) => type === "mesh3d"))
    for (let n = 0; n < trace.x.length; n++) most = Math.max(most, Math.abs((trace.x[n] - x) * u + (trace.y[n] - y) * v + (trace.z[n] - z) * w));
  return 2 * most || Number.MIN_VALUE;
}

export function rangeOf(values) {
  return values.reduce(({ low, high }, value) => ({ low: Math.min(low, value), high: Math.max(high, value) }), { low: Infinity, high: -Infinity });
}

// Show the colour scale of a field below its view, replacing the previous one; none without a field.
export function showColours(place, field) {
  place.querySelector(".colours")?.remove();
  if (field) place.append(scale(field.low, field.high, field.unit));
}
