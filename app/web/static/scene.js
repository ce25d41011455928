// What all views in three dimensions have in common: no axes, equal scales, one camera; colours of a field.
import { CONFIG, plotly, scale } from "./plots.js";

const HIDDEN = { visible: false, showbackground: false };
const LAYOUT = {
  height: 380, margin: { l: 0, r: 0, t: 0, b: 0 }, paper_bgcolor: "#fff", uirevision: "kept", showlegend: false,
  scene: { aspectmode: "data", xaxis: HIDDEN, yaxis: HIDDEN, zaxis: HIDDEN, camera: { eye: { x: 1.1, y: -1.3, z: 0.95 }, projection: { type: "orthographic" } } },
};

export const FIELD = { colorscale: "Viridis", showscale: false, lighting: { ambient: 0.9, diffuse: 0.2 } };

// Draw traces; drawn again in the same place, the view stays as it was turned.
export async function drawScene(figure, traces) {
  const Plotly = await plotly();
  await Plotly.react(figure, traces, structuredClone(LAYOUT), CONFIG);
}

// The colours of a field below its view, in the place of those of the field before; none, if there is no field.
export function showColours(place, field) {
  place.querySelector(".colours")?.remove();
  if (field) place.append(scale(field.low, field.high, field.unit));
}
