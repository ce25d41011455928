// Write an evaluation into the page: formulas with their numbers, results, errors, warnings.
import { isolated } from "./isolated.js";
import { aligned, percent, quantityText, unit } from "./numbers.js";
import { courseCell, isCourse } from "./course.js";
import { reveal } from "./reveal.js";
import { isOf } from "./typed.js";

const TEXT = "\\text{"; // beginning of a result in words

export function showResults(scope, answer) {
  for (const row of answer.formulas ?? []) showFormula(`${scope}.${row.name}`, row);
  const values = { ...answer.inputs, ...answer.outputs };
  for (const [name, quantity] of Object.entries(answer.outputs ?? {})) {
    showOutput(`${scope}.${name}`, quantity, answer.error?.[name], values);
  }
  showWarnings(scope, answer.warnings ?? []);
  showAssumed(scope, answer.assumed ?? []);
}

function showFormula(name, row) {
  const line = document.querySelector(`[data-formula="${name}"] .formula-math`);
  if (!line) return;
  for (const part of ["numbers", "result"]) {
    let place = line.querySelector(`.${part}`);
    if (!place) place = line.appendChild(Object.assign(document.createElement("span"), { className: `part ${part}` }));
    if (place.dataset.shown === row[part]) continue;
    place.dataset.shown = row[part];
    if (row[part].startsWith(TEXT)) place.textContent = `= ${row[part].slice(TEXT.length, -1)}`;
    else place.innerHTML = row.mathml[part]; // MathML that the service escaped
  }
}

function showOutput(name, quantity, error, values) {
  const line = document.querySelector(`[data-output="${name}"]`);
  if (!line) return;
  for (const old of line.querySelectorAll("td.value, td.unit")) old.remove();
  const axis = values[line.dataset.axis];
  line.querySelector(".symbol").after(...cells(quantity, axis));
  const band = line.querySelector(".band");
  band.textContent = typeof error !== "number" ? "" : error === 0 ? "same at all levels" : `± ${percent(error)}${band.dataset.of ?? ""}`;
}

export function cells(quantity, axis) {
  const value = Object.assign(document.createElement("td"), { className: "value" });
  if (isCourse(quantity.value)) return [courseCell(value, quantity, axis)];
  if (typeof quantity.value !== "number") {
    value.classList.add("text");
    value.colSpan = 2;
    value.textContent = quantityText(quantity).replaceAll("_", " ");
    return [value];
  }
  value.append(numberOf(quantity.value));
  return [value, Object.assign(document.createElement("td"), { className: "unit", textContent: unit(quantity.unit) })];
}

export function numberOf(value) {
  const parts = aligned(value).map((text, place) => part(["whole", "rest"][place], text));
  const number = part("number", "");
  number.append(...parts);
  return number;
}

const part = (className, textContent) => Object.assign(document.createElement("span"), { className, textContent });

export function showWarnings(scope, warnings) {
  const list = document.querySelector(`[data-warnings="${scope}"]`);
  list?.replaceChildren(...warnings.map(warning));
}

function showAssumed(scope, assumed) {
  const line = document.querySelector(`[data-assumed="${scope}"]`);
  if (!line) return;
  line.hidden = assumed.length === 0;
  line.textContent = `Assumed: ${assumed.map(({ detail }) => detail).join("; ")}.`;
}

export function warning({ name, detail }) {
  const item = Object.assign(document.createElement("li"), { className: "warning" });
  item.append(Object.assign(document.createElement("strong"), { textContent: name.replaceAll("_", " ") }), " ", isolated(detail));
  return item;
}

// Mark the results shown as those of the last valid input, or remove the mark.
export function markOutdated(isOutdated) {
  document.getElementById("main").classList.toggle("outdated", isOutdated);
}

// Do the same for one step of a design whose results are still being calculated.
export function markWaiting(step, isWaiting) {
  const parts = document.querySelectorAll(`[data-step="${step}"], [data-pictures="${step}"]`);
  for (const part of parts) part.classList.toggle("outdated", isWaiting);
}

export const OUTDATED = "the results shown belong to the last valid input";

// Show messages next to the fields of a form, and return those that belong to no field.
export function showFaults(form, faults) {
  const loose = new Map(faults);
  for (const field of form.querySelectorAll("input[id], select[id]")) {
    const message = document.getElementById(`${field.id}-error`);
    if (!message) continue;
    const name = [...faults.keys()].find((fault) => isOf(fault, field.name));
    const detail = faults.get(name);
    loose.delete(name);
    message.hidden = !detail;
    message.replaceChildren(...(detail ? [isolated(detail)] : []));
    field.toggleAttribute("aria-invalid", Boolean(detail));
    if (detail) field.setAttribute("aria-invalid", "true");
    if (detail) field.setAttribute("aria-describedby", message.id);
    else field.removeAttribute("aria-describedby");
    if (detail) reveal(field);
  }
  return loose;
}
