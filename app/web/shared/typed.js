// Convert between fields and JSON of the interface, as app/web/shared/forms.py does.
import { hasComma } from "./decimals.js";

// Return the interface's name of a control: `.scale` → `scale`, `film@level` → `film.level`.
export const nameOf = (control) => control.replace("@", ".").replace(/^\./, "");

// On a page with a decimal comma, quantities and lists may be typed with one: 0,58 kg. They are kept with a point.
// A comma between brackets is a decimal sign only if semicolons separate the items.
const WITH_COMMA = /^\s*(?:\[(?=[^\]]*;)\s*)?(?:[+-]?\d+[;\s]+)*[+-]?\d+,\d+(?![\d.,])/;

export const withPoints = (text) => (hasComma() && WITH_COMMA.test(text) ? text.replace(/(\d),(?=\d)/g, "$1.") : text);

document.addEventListener("change", ({ target }) => {
  if (target.matches("form.worksheet input")) target.value = withPoints(target.value);
});

export function valueOf(text) {
  const stripped = withPoints(text).trim();
  if (!/^[[{]/.test(stripped)) return stripped;
  const end = stripped.lastIndexOf(stripped[0] === "[" ? "]" : "}") + 1;
  try {
    const inside = JSON.parse(stripped.slice(0, end)), unit = stripped.slice(end).trim();
    return unit ? { value: inside, unit } : inside;
  } catch {
    return stripped; // the interface will report what is wrong with it
  }
}

// Return whether a fault belongs to a control; for an option it may name the place (`steps.film.tolerance`) or the value.
export function isOf(fault, control) {
  const name = nameOf(control);
  const isOption = control.includes("@");
  return fault === name || (isOption && (fault === `steps.${name}` || fault.startsWith(`${name}.`)));
}

export const WORKSHEET = "worksheet"; // the control with the lines of the design
const LIMITS = "limits."; // prefix in the name of a limit's control

// Return the merge patch of a design for the changed fields: { "film.radial_load": "25 kN" } → { steps: … }.
export function patchOf(changed, models) {
  const patch = {};
  for (const [name, text] of Object.entries(changed)) {
    if (name === WORKSHEET) {
      patch[name] = text.trim() === "" ? null : text;
      continue;
    }
    const [, block, kind, tail] = name.match(/^([^.@]*)([.@])(.*)$/s);
    const value = text.trim() === "" ? null : valueOf(text);
    if (kind === "@" && tail.startsWith(LIMITS)) inside(patch, "steps", block, "limits")[tail.slice(LIMITS.length)] = value;
    else if (kind === "@") inside(patch, "steps", block)[tail] = optionOf(tail, value);
    else if (!block) inside(patch, "parameters")[tail] = value;
    else if (models.has(block)) inside(patch, "models", block, "parameters")[tail] = value;
    else inside(patch, "steps", block, "inputs")[tail] = value;
  }
  return patch;
}

const inside = (patch, ...path) => path.reduce((place, key) => (place[key] ??= {}), patch);

// A tolerance must be a number; the interface reports any other text.
export const optionOf = (name, value) =>
  name === "tolerance" && typeof value === "string" && Number.isFinite(Number(value)) ? Number(value) : value;
