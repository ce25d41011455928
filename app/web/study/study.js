// The page of a study: follow its job, draw its rows with the chosen axes, and select the clicked row.
import { call, units } from "../shared/api.js";
import { plain, unit } from "../shared/numbers.js";
import { drawParallel } from "./parallel.js";
import { watched } from "../shared/progress.js";
import { startTables } from "../shared/result_table.js";
import { renewed } from "../shared/renewed.js";
import { axisTitle, drawContour, drawHistogram, drawScatter, drawTornado } from "./study_charts.js";

const MOST_DRAWN = 20000, PAGE = 500;

followJob(document.querySelector("[data-progress]"));
showResults();

function showResults() {
  startTables();
  for (const place of document.querySelectorAll("[data-tornado]")) drawTornado(place, JSON.parse(place.dataset.tornado), place.dataset.words);
  startCharts(document.querySelector("[data-charts]"));
}

async function followJob(place) {
  if (place.hidden || !place.dataset.job) return;
  const bar = place.querySelector("progress"), words = place.querySelector("[data-progress-text]");
  const badge = document.querySelector("[data-study-state]");
  await watched(place.dataset.job, (progress, text) => {
    bar.value = progress;
    if (badge.dataset.studyState === "queued") {
      badge.className = "tag running";
      badge.dataset.studyState = badge.textContent = "running";
    }
    if (text) words.textContent = text;
  });
  await renewed(words);
  showResults();
}

async function startCharts(section) {
  if (!section) return;
  const table = await tableOf(section);
  if (!table.rows.length) return;
  section.hidden = false;
  const varied = JSON.parse(section.dataset.varied), [kind, x, y, z, by] = ["chart", "x", "y", "z", "by"].map((name) => section.querySelector(`[data-${name}]`));
  if (section.dataset.chart !== undefined) kind.value = section.dataset.chart;
  if (varied.length === 2 && isGrid(table, varied)) [kind.value, x.value, y.value] = ["contour", ...varied];
  const output = firstThatVaries(table, JSON.parse(section.dataset.outputs));
  if (output) z.value = output;
  if (output && !varied.includes(y.value)) y.value = output;
  const redraw = () => draw(section, judgedBy(table, by?.value), kind.value, x.value, y.value, z.value);
  for (const choice of [kind, x, y, z, by]) choice?.addEventListener("change", redraw);
  await redraw();
}

// Return all rows with values, up to the number that a chart can show.
async function tableOf(section) {
  const names = [...JSON.parse(section.dataset.varied), ...JSON.parse(section.dataset.outputs)], symbols = JSON.parse(section.dataset.unitsOf), headings = JSON.parse(section.dataset.headings);
  const columns = Object.fromEntries(names.map((name) => [name, { words: headings[name] ?? name, unit: symbols[name], values: [] }])), rows = [], verdicts = [], each = [];
  let cursor = "";
  do {
    const { payload: page } = await call("GET", `/api/v1/studies/${section.dataset.study}/rows?limit=${PAGE}&units=${units()}${cursor && `&cursor=${encodeURIComponent(cursor)}`}`);
    for (const row of page.items.filter(({ reason }) => !reason)) {
      rows.push(row.row);
      verdicts.push(row.verdict);
      each.push(row.verdicts);
      for (const name of names) columns[name].values.push(row.values[name] ?? null);
    }
    cursor = page.next;
  } while (cursor && rows.length < MOST_DRAWN);
  return { rows, verdicts, each, columns, isWhole: !cursor };
}

// Return the table with the verdicts of a chosen criterion instead of the worst verdict of each row.
function judgedBy(table, criterion) {
  return criterion ? { ...table, verdicts: table.each.map((verdicts) => verdicts?.[criterion]) } : table;
}

// Return the first output that is not the same in all rows.
function firstThatVaries(table, outputs) {
  return outputs.find((name) => new Set(table.columns[name].values).size > 1);
}

function isGrid(table, [x, y]) {
  const sizes = [x, y].map((name) => new Set(table.columns[name].values).size);
  return sizes.every((size) => size > 1) && table.rows.length > 0.5 * sizes[0] * sizes[1] && table.rows.length <= sizes[0] * sizes[1];
}

async function draw(section, table, kind, x, y, z) {
  const place = fresh(section), words = section.querySelector("[data-charted]"), pick = (row) => show(section, table, row);
  const rest = table.isWhole ? "" : `; the first ${table.rows.length} rows are drawn`;
  words.textContent = `Click a point to see its row${rest}.`;
  if (kind === "parallel") {
    const kept = (count) => (words.textContent = `${count} of ${table.rows.length} rows kept; drag along an axis to keep a range${rest}.`);
    return drawParallel(place, table, Object.keys(table.columns), { pick, kept });
  }
  if (kind === "histogram") {
    const limits = JSON.parse(section.dataset.limits)[x] ?? [];
    words.textContent = `Number of rows by value${limits.length ? "; dashed: the limit of a criterion" : ""}${rest}.`;
    return drawHistogram(place, table, x, limits);
  }
  if (kind === "contour" && isGrid(table, [x, y])) return drawContour(place, table, x, y, z, pick);
  if (kind === "contour") words.textContent = `A contour needs a grid over ${axisTitle(table, x)} and ${axisTitle(table, y)}; the points are drawn instead.`;
  return drawScatter(place, table, x, y, pick);
}

// Return the drawing area, cleared of a previous chart.
function fresh(section) {
  const old = section.querySelector("[data-drawing]"), drawing = old.cloneNode(false);
  old.replaceWith(drawing);
  return drawing;
}

function show(section, table, row) {
  const n = table.rows.indexOf(row), panel = section.querySelector("[data-picked]");
  if (n < 0) return;
  const values = Object.entries(table.columns).map(([, { words, values, unit: symbol }]) => `${words} ${values[n] === null ? "–" : plain(values[n])} ${unit(symbol)}`.trim());
  panel.hidden = false;
  panel.querySelector("[data-picked-text]").textContent = `Row ${row}: ${values.join(", ")}${table.verdicts[n] ? `; ${table.verdicts[n].replaceAll("_", " ")}` : ""}`;
  panel.querySelector('[name="row"]').value = row;
  panel.querySelector("button").textContent = `Use row ${row}`;
}
