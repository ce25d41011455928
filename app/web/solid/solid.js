// The 3-D view of the part: a GLB file, drawn by Plotly, with the size of the part below.
import { units } from "../shared/api.js";
import { readGlb } from "./glb.js";
import { unit } from "../shared/numbers.js";
import { plotly } from "../plots/plots.js";
import { pressureOf } from "../plots/pressure.js";
import { FIELD, drawScene, showColours } from "./scene.js";
import { startFaces } from "./faces.js";

const PLAIN = { ambient: 1, diffuse: 0, specular: 0, fresnel: 0 }; // the colours of the corners already include the light
const shade = (colour, power) => `rgb(${colour.map((part) => Math.min(255, Math.round(part * power * 1.25))).join(",")})`;
const CHOSEN = [214, 140, 20]; // colour of the faces of a chosen parameter
const LEAST = 0.003; // smallest painted pressure, relative to the largest
const AGAIN = 1500, TIMES = 20; // ms

export async function showSolid(place) {
  place.setAttribute("aria-busy", "true");
  try {
    const bodies = readGlb(await fetched(place.dataset.solid));
    await drawSolid(place, bodies);
    tellSize(place);
  } catch (error) {
    place.textContent = `The part cannot be shown: ${error.message}`;
  } finally {
    place.removeAttribute("aria-busy");
  }
}

// Return the file; request it again while it is still being created (202).
async function fetched(path) {
  for (let tried = 0; tried < TIMES; tried++) {
    const answer = await fetch(path, { headers: { Prefer: "wait=10" } });
    if (answer.status === 200) return answer.arrayBuffer();
    if (answer.status !== 202) throw new Error((await answer.json()).detail);
    await new Promise((done) => setTimeout(done, AGAIN));
  }
  throw new Error("drawing it takes too long");
}

async function drawSolid(place, bodies) {
  const before = place.querySelector(".js-plotly-plot"), figure = before ?? document.createElement("div");
  if (!before) place.replaceChildren(figure);
  const traces = bodies.map((body) => ({ type: "mesh3d", ...body.mesh, vertexcolor: cornerColours(body), hoverinfo: "none", lighting: PLAIN }));
  await drawScene(figure, traces);
  startFaces(place, figure, bodies, (name) => highlight(figure, bodies, name));
}

// Return the colours of the corners; those of faces that carry the named parameter have a colour of their own.
function cornerColours({ light, colour, painted, marks }, name) {
  const isChosen = marks.map((own) => own.includes(name));
  return light.map((power, corner) => shade(isChosen[corner % marks.length] ? CHOSEN : painted ? painted[corner] : colour, power));
}

async function highlight(figure, bodies, name) {
  const Plotly = await plotly();
  await Plotly.restyle(figure, { vertexcolor: bodies.map((body) => cornerColours(body, name)) }, bodies.map((_, trace) => trace));
}

// Show the part in the colours of a field, with the file, range and unit in the chosen option; or plain again.
export async function colourBy(place, { value, dataset }) {
  place.setAttribute("aria-busy", "true");
  try {
    await drawSolid(place, readGlb(await fetched(value || place.dataset.solid)));
    showColours(place, value ? { low: Number(dataset.low), high: Number(dataset.high), unit: unit(dataset.unit) } : undefined);
  } finally {
    place.removeAttribute("aria-busy");
  }
}

function tellSize(place) {
  const caption = Object.assign(document.createElement("p"), { className: "size muted" });
  caption.textContent = `${place.dataset.size}; drag to turn, scroll to zoom`;
  place.append(caption);
}

// Paint the film pressure on the bore, with the load towards +y; or remove it.
export async function paint(place, picture, values, wanted) {
  const Plotly = await plotly();
  const figure = place.querySelector(".js-plotly-plot");
  if (!figure) throw new Error("the part is not drawn");
  const painted = figure.data.findIndex((trace) => trace.name === "film pressure");
  if (painted >= 0) await Plotly.deleteTraces(figure, painted);
  showColours(place);
  if (!wanted) return;
  const field = await pressureOf(picture, values), { pressure, maximum_pressure: most } = await pressureOf(picture, values, units());
  const radius = 0.497 * field.bearing_diameter.value; // in mm, as in the solid
  const start = Math.PI / 2 + (field.attitude_angle.value * Math.PI) / 180;
  const angles = field.angle.value.map((angle) => start + (angle * Math.PI) / 180);
  const rows = field.place.value, least = LEAST * field.maximum_pressure.value;
  const lowest = figure.data.reduce((low, { y }) => y.reduce((one, other) => Math.min(one, other), low), Infinity); // 0 for a half shell
  const isOff = (row, n) => field.pressure.value[row][n] < least || radius * Math.sin(angles[n]) < lowest;
  const on = (value) => rows.map((z, row) => angles.map((angle, n) => (isOff(row, n) ? null : value(angle, z))));
  const surface = {
    type: "surface", name: "film pressure", scene: figure.dataset.scene, surfacecolor: pressure.value, ...FIELD,
    x: on((angle) => radius * Math.cos(angle)), y: on((angle) => radius * Math.sin(angle)), z: on((_, z) => z),
    hovertemplate: "%{surfacecolor:.3g} " + unit(pressure.unit) + "<extra></extra>",
  };
  await Plotly.addTraces(figure, surface);
  showColours(place, { low: 0, high: most.value, unit: unit(most.unit) });
}
