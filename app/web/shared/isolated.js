// Put a user's text into a separate element, so that direction marks in it affect no other text; see app/presentation/bidi.py.
const BREAKS = /[\u2028\u2029\u0085]/g, CLOSES = "\u2069", OPENS = ["\u2066", "\u2067", "\u2068"];

export const isolated = (text) => Object.assign(document.createElement("bdi"), { textContent: balanced(String(text)) });

function balanced(text) {
  let open = 0, kept = "";
  for (const sign of text.replace(BREAKS, " ")) {
    if (sign === CLOSES && open === 0) continue;
    open += OPENS.includes(sign) ? 1 : sign === CLOSES ? -1 : 0;
    kept += sign;
  }
  return kept;
}
