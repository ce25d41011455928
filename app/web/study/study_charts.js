// Charts of a study's rows: scatter, contour with the feasible region, histogram with limits, tornado.
//
// `table` holds columns by name, `{ words, unit, values }`, one value a row, and `verdicts`, one worst verdict a row.
import { unit } from "../shared/numbers.js";
import { COLOURS, draw } from "../plots/plots.js";

const TONES = { met: "#1d6b3a", undecided: "#c98b12", not_checked: "#5a5f66", not_met: "#a3221b" };
const WORDS = { met: "met", undecided: "undecided", not_checked: "not checked", not_met: "not met" };

export const axisTitle = (table, name) => `${table.columns[name].words}${unit(table.columns[name].unit) ? ` [${unit(table.columns[name].unit)}]` : ""}`;

// Draw one mark for each row, coloured by its worst verdict; `pick` receives the clicked row.
export async function drawScatter(place, table, x, y, pick) {
  const traces = groups(table).map(([verdict, rows]) => ({
    type: "scatter", mode: "markers", name: WORDS[verdict] ?? "no criteria", customdata: rows.map((row) => table.rows[row]),
    x: rows.map((row) => table.columns[x].values[row]), y: rows.map((row) => table.columns[y].values[row]),
    marker: { size: 6, color: TONES[verdict] ?? COLOURS[0] }, hovertemplate: `${table.columns[x].words} %{x:.5g}<br>${table.columns[y].words} %{y:.5g}<extra>row %{customdata}</extra>`,
  }));
  await draw(place, traces, { height: 380, showlegend: traces.length > 1, ...axes(table, x, y) });
  picked(place, pick);
}

// Draw an output over two inputs of a grid, and mark the rows that meet every criterion.
export async function drawContour(place, table, x, y, z, pick) {
  const across = distinct(table.columns[x].values), upright = distinct(table.columns[y].values);
  const cells = upright.map(() => across.map(() => null)), worst = upright.map(() => across.map(() => null));
  const column = new Map(across.map((value, n) => [value, n])), line = new Map(upright.map((value, n) => [value, n]));
  table.columns[z].values.forEach((value, row) => {
    const at = [line.get(table.columns[y].values[row]), column.get(table.columns[x].values[row])];
    cells[at[0]][at[1]] = value;
    worst[at[0]][at[1]] = ["met", null, undefined].includes(table.verdicts[row]) ? 1 : 0;
  });
  const traces = [{ type: "contour", x: across, y: upright, z: cells, colorscale: "Viridis", showscale: false, contours: { coloring: "fill", showlabels: true }, hovertemplate: `${table.columns[x].words} %{x:.5g}<br>${table.columns[y].words} %{y:.5g}<br>${table.columns[z].words} %{z:.5g}<extra></extra>` }];
  if (table.verdicts.some((verdict) => verdict && verdict !== "met")) {
    traces.push({ type: "contour", x: across, y: upright, z: worst, showscale: false, contours: { type: "constraint", operation: ">", value: 0.5 }, fillcolor: "rgba(163, 34, 27, 0.35)", line: { color: TONES.not_met, width: 2 }, hoverinfo: "skip", showlegend: false, name: "not met" });
  }
  await draw(place, traces, { height: 420, ...axes(table, x, y) });
  picked(place, pick && ((_, point) => pick(rowAt(table, x, y, point))));
}

// Draw the histogram of an output; the limit of a criterion is a line.
export async function drawHistogram(place, table, name, limits = []) {
  const shapes = limits.map((limit) => ({ type: "line", x0: limit, x1: limit, y0: 0, y1: 1, yref: "paper", line: { color: TONES.not_met, width: 2, dash: "dash" } }));
  const title = { text: axisTitle(table, name) };
  await draw(place, [{ type: "histogram", x: table.columns[name].values, marker: { color: COLOURS[0] } }], { height: 300, shapes, bargap: 0.05, xaxis: { title }, yaxis: { title: { text: "rows" } } });
}

// Draw the effect of each input on an output as bars, largest on top. `parts` are `{ name, value, low?, high? }`.
export async function drawTornado(place, parts, words) {
  const sorted = [...parts].sort((a, b) => Math.abs(a.value) - Math.abs(b.value));
  const spread = sorted.map(({ value, low, high }) => [high === undefined ? 0 : high - value, low === undefined ? 0 : value - low]);
  const bars = {
    type: "bar", orientation: "h", y: sorted.map(({ name }) => name), x: sorted.map(({ value }) => value), marker: { color: sorted.map(({ value }) => (value < 0 ? COLOURS[1] : COLOURS[0])) },
    error_x: { type: "data", array: spread.map(([up]) => up), arrayminus: spread.map(([, down]) => down), color: "#5a5f66", visible: spread.some((ends) => ends.some(Boolean)) },
    hovertemplate: "%{y}: %{x:.4g}<extra></extra>",
  };
  await draw(place, [bars], { height: 90 + 34 * sorted.length, xaxis: { title: { text: words } } });
}

function axes(table, x, y) {
  return { xaxis: { title: { text: axisTitle(table, x) } }, yaxis: { title: { text: axisTitle(table, y) } }, hovermode: "closest" };
}

// Return the rows of each verdict.
function groups(table) {
  const rows = new Map();
  table.verdicts.forEach((verdict, row) => {
    if (!rows.has(verdict ?? "")) rows.set(verdict ?? "", []);
    rows.get(verdict ?? "").push(row);
  });
  return [...rows.entries()];
}

const distinct = (values) => [...new Set(values)].sort((a, b) => a - b);

function rowAt(table, x, y, point) {
  const row = table.rows.findIndex((_, n) => table.columns[x].values[n] === point.x && table.columns[y].values[n] === point.y);
  return table.rows[row];
}

// A drawing that was replaced while Plotly was loading receives no clicks.
function picked(place, pick) {
  place.removeAllListeners?.("plotly_click");
  if (pick) place.on?.("plotly_click", ({ points }) => pick(points[0].customdata, points[0]));
}
