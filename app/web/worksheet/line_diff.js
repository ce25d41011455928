// Compare two texts line by line.
const MOST = 1_000_000; // largest number of compared pairs; beyond it, all lines between the first and the last difference count as different

// Return lines in order as [sign, text]: " " in both texts, "-" only in the old one, "+" only in the new one.
export function lineDiff(old, now) {
  const [before, after] = [linesOf(old), linesOf(now)];
  let head = 0, tail = 0;
  const most = Math.min(before.length, after.length);
  while (head < most && before[head] === after[head]) head += 1;
  while (tail < most - head && before.at(-1 - tail) === after.at(-1 - tail)) tail += 1;
  const both = (text) => [" ", text];
  const middle = changes(before.slice(head, before.length - tail), after.slice(head, after.length - tail));
  return [...before.slice(0, head).map(both), ...middle, ...before.slice(before.length - tail).map(both)];
}

const linesOf = (text) => text.replace(/\n$/, "").split("\n");

// By the longest common subsequence.
function changes(old, now) {
  if (old.length * now.length > MOST) return [...old.map((text) => ["-", text]), ...now.map((text) => ["+", text])];
  const width = now.length + 1, lengths = new Uint32Array((old.length + 1) * width);
  for (let row = old.length - 1; row >= 0; row -= 1) {
    for (let column = now.length - 1; column >= 0; column -= 1) {
      const [down, right] = [lengths[(row + 1) * width + column], lengths[row * width + column + 1]];
      lengths[row * width + column] = old[row] === now[column] ? lengths[(row + 1) * width + column + 1] + 1 : Math.max(down, right);
    }
  }
  const lines = [];
  let row = 0, column = 0;
  while (row < old.length || column < now.length) {
    if (row < old.length && column < now.length && old[row] === now[column]) {
      lines.push([" ", old[row]]);
      row += 1;
      column += 1;
    } else if (column === now.length || (row < old.length && lengths[(row + 1) * width + column] >= lengths[row * width + column + 1])) lines.push(["-", old[row++]]);
    else lines.push(["+", now[column++]]);
  }
  return lines;
}

const AROUND = 2; // equal lines shown around a difference
const SAID = { "-": "removed: ", "+": "added: ", " ": "" };

// Draw a difference; equal lines far from it are left out.
export function drawDiff(place, old, now) {
  const lines = lineDiff(old, now), shown = new Set();
  for (const [at, [sign]] of lines.entries()) {
    if (sign !== " ") for (let near = at - AROUND; near <= at + AROUND; near += 1) shown.add(near);
  }
  const rows = [];
  for (const [at, [sign, text]] of lines.entries()) {
    if (!shown.has(at)) {
      if (rows.at(-1)?.className !== "left-out") rows.push(node("li", "left-out", "…"));
      continue;
    }
    const row = node("li", { "-": "removed", "+": "added", " ": "" }[sign], "");
    row.append(node("span", "hidden-words", SAID[sign]), node("code", "", `${sign} ${text}`));
    rows.push(row);
  }
  const isEqual = lines.every(([sign]) => sign === " ");
  place.replaceChildren(isEqual ? node("p", "muted", "Nothing differs.") : listOf(rows));
}

function listOf(rows) {
  const list = node("ol", "diff", "");
  list.append(...rows);
  return list;
}

const node = (tag, className, textContent) => Object.assign(document.createElement(tag), { className, textContent });
