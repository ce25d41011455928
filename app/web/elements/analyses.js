// Draw one analysis as a table, as app/web/elements/elements.html does.
import { percent, quantityText } from "../shared/numbers.js";
import { cells, numberOf, warning } from "../shared/results.js";

const LOADED = ["torsion", "bending"]; // kinds that have a load
const HELD = [...LOADED, "chain"]; // kinds with a choice of supports at the loaded end
const HEADS = ["Quantity", "Value", "Unit", "Error, estimated", "Elements / degrees of freedom"];

// Insert an analysis into the list: replace its own table, else add it in front. A surface alone has no table.
export function showAnalysis(list, analysis) {
  const node = table(analysis), old = list.querySelector(`[data-analysis="${analysis.id}"]`);
  if (old) old.replaceWith(node);
  else if (node.querySelector("tbody tr")) list.prepend(node);
}

function table(analysis) {
  const kind = capital(words(analysis.kind));
  const place = element("div", { className: "scroll", tabIndex: 0, role: "region" });
  place.dataset.analysis = analysis.id;
  const asked = analysis.tolerance === null ? `level ${analysis.level}` : `within ${percent(analysis.tolerance)}`;
  const held = HELD.includes(analysis.kind) ? `${words(analysis.boundary)}, ` : "";
  const caption = element("caption", {}, `${kind} `, element("span", { className: "muted" }, `${held}${asked}${LOADED.includes(analysis.kind) ? `; under ${quantityText(analysis.load)}` : ""}`));
  place.ariaLabel = caption.textContent;
  const head = element("thead", {}, element("tr", {}, ...HEADS.map((text) => element("th", { scope: "col" }, text))));
  const rows = Object.entries(analysis.outputs).filter(([name]) => name !== "surface").flatMap(rowsOf);
  place.append(element("table", { className: "results elements-results" }, caption, head, element("tbody", {}, ...rows)));
  if (analysis.warnings.length) place.append(element("ul", { className: "warnings" }, ...analysis.warnings.map(warning)));
  return place;
}

function rowsOf(named) {
  const [name, { columns, value }] = named;
  return columns && value ? [row(named), folded(name, columns, value)] : [row(named)];
}

// All rows of a table, folded.
function folded(name, columns, value) {
  const head = element("tr", {}, ...["No.", ...columns].map((text) => element("th", { scope: "col" }, text)));
  const rows = value.map((numbers, place) => element("tr", {}, element("th", { scope: "row" }, String(place + 1)), ...numbers.map((number) => element("td", { className: "value" }, numberOf(number)))));
  const whole = element("table", { className: "results" }, element("thead", {}, head), element("tbody", {}, ...rows));
  const details = element("details", {}, element("summary", {}, `All ${value.length} rows`), whole);
  const node = element("tr", {}, element("td", { colSpan: 5 }, details));
  node.dataset.table = name;
  return node;
}

function row([name, output]) {
  const mesh = element("td", { className: "count" }, `${output.mesh.elements} / ${output.mesh.degrees_of_freedom}`);
  const band = typeof output.error === "number" ? `± ${percent(output.error)}` : "";
  const node = element("tr", {}, element("th", { scope: "row" }, capital(words(name))), ...cells(output), element("td", { className: "band" }, band, ...unestimated(output)), mesh);
  node.dataset.analysisOutput = name;
  return node;
}

const unestimated = ({ error_reason: title }) => (title ? [element("span", { className: "muted", title }, "not estimated")] : []);

function element(tag, properties, ...inside) {
  const node = Object.assign(document.createElement(tag), properties);
  node.append(...inside);
  return node;
}

const words = (name) => name.replaceAll("_", " ");
const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);
