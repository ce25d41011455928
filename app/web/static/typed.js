// Fields and the JSON of the interface, as app/web/forms.py turns one into the other.
const OPTIONS = ["level", "tolerance"];

export function valueOf(text) {
  const stripped = text.trim();
  if (!/^[[{]/.test(stripped)) return stripped;
  const end = stripped.lastIndexOf(stripped[0] === "[" ? "]" : "}") + 1;
  try {
    const inside = JSON.parse(stripped.slice(0, end)), unit = stripped.slice(end).trim();
    return unit ? { value: inside, unit } : inside;
  } catch {
    return stripped; // the interface says what is wrong with it
  }
}

// The merge patch of a design for the fields that were changed: { "film.radial_load": "25 kN" } → { steps: … }.
export function patchOf(changed, models) {
  const patch = {};
  for (const [name, text] of Object.entries(changed)) {
    const [block, tail] = name.split(".");
    const value = text.trim() === "" ? null : valueOf(text);
    if (!tail) inside(patch, "parameters")[name] = value;
    else if (models.has(block)) inside(patch, "models", block, "parameters")[tail] = value;
    else if (OPTIONS.includes(tail)) inside(patch, "steps", block)[tail] = option(tail, value);
    else inside(patch, "steps", block, "inputs")[tail] = value;
  }
  return patch;
}

const inside = (patch, ...path) => path.reduce((place, key) => (place[key] ??= {}), patch);
const option = (name, value) =>
  name === "tolerance" && value !== null && !Number.isNaN(Number(value)) ? Number(value) : value;
