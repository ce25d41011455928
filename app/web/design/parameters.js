// Values next to the fields: results of relations, and model parameters old → new with their status.
import { isolated } from "../shared/isolated.js";
import { quantityText, roundedText, unit } from "../shared/numbers.js";

const TO_DO = "set it, or link it to an output"; // same text as in app/web/shared/parts.html

export function showValues(form, block, { inputs }, rounded) {
  for (const [tail, quantity] of Object.entries(inputs ?? {})) {
    const place = form.querySelector(`[data-value="${block}.${tail}"]`);
    const field = form.querySelector(`[name="${block}.${tail}"]`);
    if (!place || !field) continue;
    const isRelation = field.value.trim().startsWith("=");
    const row = rounded.get(block ? `${block}.${tail}` : tail);
    if (isRelation) place.textContent = row ? roundedText(row) : `= ${quantityText(quantity)}`;
    else if (field.value.trim()) place.textContent = "";
  }
}

export function showParameters(parameters, rounded) {
  for (const [name, { old, new: now, status, detail }] of Object.entries(parameters)) {
    const line = document.querySelector(`[data-parameter="${name}"]`);
    if (!line) continue;
    const differs = status === "ok" && old, row = rounded.get(name);
    if (differs || status !== "unchanged") {
      line.classList.toggle("changed-value", Boolean(differs));
      line.querySelector(".comes-to").replaceChildren(...shown(differs ? old : null, now, row), ...tag(status, detail));
    } else if (line.dataset.previewed) {
      line.classList.remove("changed-value");
      line.querySelector(".comes-to").replaceChildren(...shown(null, now, row));
    }
    line.dataset.previewed = "true";
  }
}

function shown(old, now, row) {
  if (!now) return [];
  const parts = row ? [span("new", roundedText(row))] : [span("new", quantityText({ value: now.value })), " ", span("unit", unit(now.unit))];
  return old ? [span("old", `${quantityText({ value: old.value })} → `), ...parts] : parts;
}

function tag(status, detail) {
  if (status === "ok" || status === "unchanged") return [];
  const node = span(`tag status ${status === "missing" || status === "unit_mismatch" ? "failed" : "pending"}`, status.replaceAll("_", " "));
  const words = status === "missing" ? TO_DO : detail;
  return words ? [" ", node, " ", explained(words)] : [" ", node];
}

function explained(words) {
  const node = span("field-error", "");
  node.append(isolated(words));
  return node;
}

const span = (className, textContent) => Object.assign(document.createElement("span"), { className, textContent });
