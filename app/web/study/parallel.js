// Parallel coordinates of a study: one line for each row, over vertical axes. Dragging along an axis selects its rows.
//
// Plotly's own chart generates code at run time, which the pages' security policy forbids.
import { plain, unit } from "../shared/numbers.js";

const SVG = "http://www.w3.org/2000/svg", WIDTH = 900, HEIGHT = 320, TOP = 46, BOTTOM = 26, SIDE = 60, MOST_LINES = 2000;

// `names` are the columns; `pick` receives the row of a clicked line, `kept` the number of selected rows.
export function drawParallel(place, table, names, { pick, kept }) {
  const axes = names.map((name, n) => axisOf(table.columns[name], table.columns[name].words, SIDE + (n * (WIDTH - 2 * SIDE)) / Math.max(1, names.length - 1)));
  const drawing = element("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: "parallel", role: "img", "aria-label": `${table.rows.length} rows over ${names.join(", ")}` });
  const every = Math.max(1, Math.ceil(table.rows.length / MOST_LINES)), lines = [];
  for (let row = 0; row < table.rows.length; row += every) {
    const line = element("path", { d: pathOf(axes, row), class: `line ${table.verdicts[row] ?? ""}` });
    line.addEventListener("click", () => pick(table.rows[row]));
    lines.push([row, line]);
  }
  const filter = () => {
    const inside = (row) => axes.every(({ values, brush }) => !brush || (values[row] >= brush[0] && values[row] <= brush[1]));
    for (const [row, line] of lines) line.classList.toggle("out", !inside(row));
    kept(table.rows.filter((_, row) => inside(row)).length);
  };
  drawing.append(...lines.map(([, line]) => line), ...axes.flatMap((axis) => drawnAxis(axis, drawing, filter)));
  place.replaceChildren(drawing);
  filter();
}

function axisOf({ values, unit: symbol }, name, x) {
  const present = values.filter((value) => typeof value === "number");
  const low = present.reduce((a, b) => Math.min(a, b), Infinity), high = present.reduce((a, b) => Math.max(a, b), -Infinity);
  return { name, symbol, x, values, low, high, brush: null };
}

const share = ({ low, high }, value) => (high > low ? (value - low) / (high - low) : 0.5);
const heightOf = (axis, value) => TOP + (1 - share(axis, value)) * (HEIGHT - TOP - BOTTOM);

// A refused row has no value on some axis, where its line ends.
function pathOf(axes, row) {
  let pieces = "", isDown = false;
  for (const axis of axes) {
    const value = axis.values[row], isNumber = typeof value === "number";
    if (isNumber) pieces += `${isDown ? "L" : "M"}${axis.x.toFixed(1)},${heightOf(axis, value).toFixed(1)}`;
    isDown = isNumber;
  }
  return pieces;
}

function drawnAxis(axis, drawing, filter) {
  const brush = element("rect", { class: "brush", x: axis.x - 8, width: 16, y: TOP, height: 0 });
  const track = element("rect", { class: "track", x: axis.x - 12, width: 24, y: TOP, height: HEIGHT - TOP - BOTTOM });
  const title = element("title", {});
  title.textContent = "Drag to keep a range; click to keep all";
  track.append(title);
  const valueAt = (event) => {
    const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(drawing.getScreenCTM().inverse());
    const at = Math.min(1, Math.max(0, 1 - (point.y - TOP) / (HEIGHT - TOP - BOTTOM)));
    return axis.low + at * (axis.high - axis.low);
  };
  let begun = null;
  track.addEventListener("pointerdown", (event) => {
    begun = valueAt(event);
    track.setPointerCapture(event.pointerId);
  });
  track.addEventListener("pointermove", (event) => {
    if (begun !== null) show([begun, valueAt(event)]);
  });
  track.addEventListener("pointerup", (event) => {
    const ends = [begun, valueAt(event)];
    begun = null;
    show(Math.abs(heightOf(axis, ends[0]) - heightOf(axis, ends[1])) < 3 ? null : ends);
    filter();
  });
  const show = (ends) => {
    axis.brush = ends && [Math.min(...ends), Math.max(...ends)];
    brush.setAttribute("y", ends ? heightOf(axis, axis.brush[1]) : TOP);
    brush.setAttribute("height", ends ? heightOf(axis, axis.brush[0]) - heightOf(axis, axis.brush[1]) : 0);
  };
  const words = axis.name.split("."), name = label(words.at(-1).replaceAll("_", " "), axis.x, 14, "name");
  return [element("path", { class: "axis", d: `M${axis.x},${TOP}V${HEIGHT - BOTTOM}` }), brush, track, name, label(end(axis.high, axis), axis.x, TOP - 8, "end"), label(end(axis.low, axis), axis.x, HEIGHT - 8, "end")];
}

const end = (value, { symbol }) => (Number.isFinite(value) ? `${plain(value)} ${unit(symbol)}`.trim() : "none");

function label(text, x, y, kind) {
  const node = element("text", { x, y, class: kind, "text-anchor": "middle" });
  node.textContent = text;
  return node;
}

function element(name, attributes) {
  const node = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  return node;
}
