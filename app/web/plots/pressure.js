// The pressure of a journal's film: requested once for equal inputs, drawn unrolled or as a surface.
import { call, units } from "../shared/api.js";
import { unit } from "../shared/numbers.js";
import { draw, scale } from "./plots.js";

const answers = new Map();

export function pressureOf(picture, values, system = "si") {
  const asked = Object.fromEntries(Object.entries(picture.inputs).map(([name, from]) => [name, typedOf(values[from])]));
  const key = `${system} ${JSON.stringify(asked)}`;
  if (!answers.has(key)) answers.set(key, call("POST", `/api/v1/film-pressure?units=${system}`, { inputs: asked }).then(({ payload }) => payload));
  return answers.get(key);
}

const typedOf = ({ value, unit }) => ({ value, unit });

export async function drawPressure(place, picture, values) {
  const field = await pressureOf(picture, values, units());
  const x = field.angle.value, y = field.place.value, z = field.pressure.value, shown = unit(field.pressure.unit);
  if (place.children.length !== 4) place.replaceChildren(pane(), pane(), pane(), pane());
  const [map, legend, middle, surface] = place.children;
  const colours = { colorscale: "Viridis", showscale: false };
  legend.replaceChildren(scale(0, field.maximum_pressure.value, shown));
  await draw(map, [{ type: "contour", x, y, z, ...colours, contours: { showlines: false }, ncontours: 24 }], {
    height: 230, margin: { l: 55, r: 10, t: 10, b: 45 },
    xaxis: { title: { text: "angle from the narrowest gap, in the sense of rotation [°]" }, dtick: 60 }, yaxis: { title: { text: `along the shaft [${unit(field.place.unit)}]` } },
  });
  await draw(middle, [{ x, y: z[(z.length - 1) / 2], mode: "lines", fill: "tozeroy" }], {
    height: 200, margin: { l: 55, r: 10, t: 10, b: 45 },
    xaxis: { title: { text: "angle at mid-width [°]" }, dtick: 60 }, yaxis: { title: { text: `p [${shown}]` } },
  });
  await draw(surface, [{ type: "surface", x, y, z, ...colours }], {
    height: 320, margin: { l: 0, r: 0, t: 0, b: 0 },
    scene: { xaxis: { title: { text: "angle [°]" } }, yaxis: { title: { text: unit(field.place.unit) } }, zaxis: { title: { text: shown } }, aspectratio: { x: 1.6, y: 0.8, z: 0.8 }, camera: { eye: { x: -1.2, y: -1.8, z: 0.9 } } },
  });
}

const pane = () => document.createElement("div");
