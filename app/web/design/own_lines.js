// The worksheet of a design: its text with faults, its lines with their values, and its plots.
import { isolated } from "../shared/isolated.js";
import { plain, unit } from "../shared/numbers.js";
import { draw } from "../plots/plots.js";
import { whenSeen } from "../plots/pictures.js";
import { WORKSHEET } from "../shared/typed.js";
import { SheetNames } from "../worksheet/sheet_names.js";
import { SheetText } from "../worksheet/sheet_text.js";
import { Typeset } from "../worksheet/typeset.js";

const PLACE = /^line (\d+), column (\d+): ([\s\S]*)$/; // how the service begins the fault of a line

export class OwnLines {
  // `names` are the names that relations of the design may use.
  constructor(section, names) {
    const find = (selector) => section.querySelector(selector);
    this.section = section;
    this.area = find("textarea");
    this.text = new SheetText(this.area, find("[data-lines]"));
    this.typeset = new Typeset(find("[data-typeset]"));
    this.plots = find("[data-line-plots]");
    this.count = find("[data-lines-faults]");
    this.sheetNames = new SheetNames(this.text);
    this.names = names;
    this.lines = [];
    this.area.addEventListener("input", () => this.text.draw());
  }

  // Show the lines of a preview with the verdicts of their checks.
  show({ worksheet = [], criteria }) {
    const judged = new Map((criteria ?? []).map((one) => [one.name, one]));
    this.lines = worksheet;
    this.draw(worksheet.filter(({ kind }) => kind !== "plot").map((line) => shown(line, judged.get(line.name))), []);
    this.drawPlots(worksheet.filter(({ kind }) => kind === "plot"));
    this.sheetNames.update(this.names.list.filter(({ name }) => !name.startsWith(`${WORKSHEET}.`)));
  }

  // Show the faults of lines; return the other faults.
  takeFaults(faults) {
    this.text.draw();
    const own = [...faults].filter(([name]) => name === WORKSHEET || name.startsWith(`${WORKSHEET}.`));
    const placed = own.map(([, detail]) => faultOf(detail));
    if (placed.length) {
      this.section.open = true;
      this.draw([], placed);
    } else this.text.showFaults([]);
    return new Map([...faults].filter(([name]) => !own.some(([other]) => other === name)));
  }

  draw(lines, faults) {
    this.text.draw();
    this.text.showFaults(faults);
    this.typeset.show({ lines: joined(lines), faults, tests: [] });
    this.count.textContent = faults.length ? `${faults.length} ${faults.length === 1 ? "fault" : "faults"}` : "";
    this.area.toggleAttribute("aria-invalid", faults.length > 0);
    if (faults.length) this.area.setAttribute("aria-invalid", "true");
  }

  drawPlots(plots) {
    const key = JSON.stringify(plots);
    if (key === this.drawn) return;
    this.drawn = key;
    this.plots.replaceChildren(...plots.map(figure));
  }
}

// Return names for completion in all fields of a form: in the lines those of the worksheet, elsewhere those of relations.
export function namesOf(names, lines) {
  const of = (field) => (field === lines.area ? lines.sheetNames : names);
  return {
    takes: (field) => of(field).takes(field),
    start: (field) => of(field).start(field),
    matching: (field, typed) => of(field).matching(field, typed),
    fits: (item, field) => of(field).fits(item, field),
    put: (field, name, start, end) => of(field).put(field, name, start, end),
    box: (field) => of(field).box(field),
  };
}

function shown(line, verdict) {
  const { value, reason, mathml = "", html = "" } = line, variant = verdict?.where?.variant;
  const message = verdict ? [variant, verdict.sentence].filter(Boolean).join(": ") : reason;
  return { ...line, mathml, html, value: value?.value, unit: value?.unit, verdict: verdict?.verdict, message };
}

// A system of equations has one line of text and several results.
function joined(lines) {
  const rows = new Map();
  for (const line of lines) {
    const first = rows.get(line.line);
    rows.set(line.line, first ? { ...first, text: `${first.text ?? textOf(first)}, ${textOf(line)}` } : line);
  }
  return [...rows.values()];
}

const textOf = ({ words, value, unit: symbol }) => `${words} ${typeof value === "number" ? plain(value) : "–"} ${unit(symbol ?? "")}`.trim();

function faultOf(detail) {
  const [, line, column, message] = detail.match(PLACE) ?? [null, "1", "1", detail];
  return { line: Number(line), column: Number(column), message, remedy: "" };
}

function figure({ words, plot, reason }) {
  const node = Object.assign(document.createElement("figure"), { className: "plot" }), caption = document.createElement("figcaption");
  caption.append(isolated(plot ? words : `${words}: no plot, because ${reason}`));
  node.append(caption);
  if (!plot) return node;
  const place = Object.assign(document.createElement("div"), { className: "drawing" });
  node.prepend(place);
  whenSeen(node, () => drawn(place, plot).catch((error) => (place.textContent = `This plot could not be drawn: ${error.message}`)));
  return node;
}

function drawn(place, { x, y, rows }) {
  const order = x.values.value.map((_, at) => at);
  if (rows) order.sort((one, other) => x.values.value[one] - x.values.value[other]);
  const of = ({ values }) => order.map((at) => values.value[at]);
  const trace = { x: of(x), y: of(y), mode: rows ? "lines+markers" : "lines", text: rows && order.map((at) => rows[at]) };
  return draw(place, [trace], { showlegend: false, xaxis: { title: { text: label(x) } }, yaxis: { title: { text: label(y) } } });
}

const label = ({ words, values }) => (unit(values.unit) ? `${words} [${unit(values.unit)}]` : words);
