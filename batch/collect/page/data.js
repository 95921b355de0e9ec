/* The batch by columns: what a cell has in each, how that is written, and in which order it comes. */

const batch = JSON.parse(document.getElementById("data").textContent);
const MISSING = "–";

const STATES = new Map([
  ["done", { sign: "✓", word: "Done" }],
  ["no solution", { sign: "✕", word: "No solution" }],
  ["wrong input", { sign: "!", word: "Wrong input" }],
  ["failed", { sign: "⚠", word: "Failed" }],
  ["planned", { sign: "○", word: "Not run yet" }],
]);
const PROBLEMS = ["failed", "wrong input", "no solution"];

const collator = new Intl.Collator(undefined, { numeric: true, sensitivity: "base" });
const counted = (n, one, many) => `${n.toLocaleString("en")} ${n === 1 ? one : many}`;

/** A number as written in the table: four digits that count, in full where it was chosen. */
function written(x) {
  if (x === null || x === undefined || x === "") return MISSING;
  return typeof x === "number" && !Number.isInteger(x) ? String(Number(x.toPrecision(4))) : String(x);
}

/** A column: `at(i)` is what cell i has there, null where nothing. */
class Column {
  constructor(key, name, group, at, number, short = name) {
    Object.assign(this, { key, name, group, at, number, short });
  }

  /** What cells have here, each once, in order. */
  get distinct() {
    this.found ??= [...new Set(order.map(this.at).filter((x) => x !== null))].sort(compared);
    return this.found;
  }

  text(i) {
    return this.key === "state" ? STATES.get(this.at(i)).word : written(this.at(i));
  }
}

function compared(a, b) {
  return typeof a === "number" && typeof b === "number" ? a - b : collator.compare(String(a), String(b));
}

const order = batch.cells.map((_, i) => i);

// As figures' names end (batch/cells/figures.py); longer ends first.
const UNITS = {
  nm_per_kg: "N·m/kg", bw_per_s: "BW/s", bw_m: "BW·m", percent: "%", deg: "°", bw: "BW", nm: "N·m", mm: "mm", cm: "cm",
  n: "N", m: "m", s: "s",
};

/** A figure's name in words, its unit behind. */
function figureWords(name) {
  const end = Object.keys(UNITS).find((each) => name.endsWith(`_${each}`));
  const words = (end ? name.slice(0, -end.length - 1) : name).replaceAll("_", " ");
  return end ? `${words} (${UNITS[end]})` : words;
}

function tableColumns(group, table) {
  return table.map(({ name, short, column }) => {
    const number = column.every((x) => x === null || typeof x === "number");
    const words = group === "figure" ? figureWords(name) : name;
    return new Column(`${group}:${name}`, words, group, (i) => column[i], number, short);
  });
}

const outcome = (i) => batch.sentences[batch.sentence[i]] || batch.headlines[i]?.[0] || null;
const reasonKind = (i) => batch.sentences[batch.sentence[i]].replace(/\d+([.,]\d+)?/g, "…") || null;
const columns = [
  new Column("number", "Cell", "", (i) => i + 1, true),
  new Column("clip", "Clip", "", (i) => batch.clips[batch.clip[i]], false),
  new Column("recipe", "Recipe", "", (i) => batch.recipes[batch.recipe[i]] || null, false),
  new Column("state", "State", "", (i) => batch.states[batch.state[i]], false),
  ...tableColumns("value", batch.values),
  ...tableColumns("figure", batch.figures),
  new Column("seconds", "Time (s)", "", (i) => batch.seconds[i], true),
  new Column("outcome", "Result or reason", "", outcome, false),
  new Column("reason", "Reason", "", reasonKind, false),
];
const tabled = columns.filter((column) => column.key !== "reason"); // which is but to filter by
const byKey = new Map(columns.map((column) => [column.key, column]));
const values = columns.filter((column) => column.group === "value");
const figures = columns.filter((column) => column.group === "figure");
const varies = (column) => order.some((i) => column.at(i) !== column.at(0));
const stateOf = byKey.get("state").at;

/** The address of a file of a cell, relative to this page; names may hold any letter. */
function address(i, file) {
  return ["cells", batch.cells[i], ...file.split("/")].map(encodeURIComponent).join("/");
}
const fileSet = (i) => batch.file_sets[batch.files[i]];
const picture = (i) => (fileSet(i).includes(batch.picture) ? address(i, batch.picture) : null);
const film = (i) => fileSet(i).find((file) => /\.(mp4|webm)$/.test(file)) ?? null;
const anyPicture = batch.file_sets.some((files) => files.includes(batch.picture));

/** A duration in words. */
function lasting(seconds) {
  if (seconds < 90) return `${Math.round(seconds)} s`;
  return seconds < 5400 ? `${Math.round(seconds / 60)} min` : `${(seconds / 3600).toFixed(1)} h`;
}

/** The values that vary, such as "forward 0.2, up 0.1". */
function variation(i) {
  return values.filter((column) => varies(column) && column.at(i) !== null)
    .map((column) => `${column.short} ${column.text(i)}`).join(", ");
}

/** An element with properties, and what it holds; text is never read as markup. */
function make(tag, properties = {}, ...held) {
  const { data: dataset = {}, aria = {}, ...own } = properties;
  const made = Object.assign(document.createElement(tag), own);
  Object.assign(made.dataset, dataset);
  for (const [name, value] of Object.entries(aria)) {
    made.setAttribute(name === "role" ? name : `aria-${name}`, value);
  }
  made.append(...held);
  return made;
}

function stateMark(state, more = "") {
  const { sign, word } = STATES.get(state);
  const mark = make("span", { className: `state ${state.replace(" ", "-")}` });
  mark.append(make("span", { aria: { hidden: "true" } }, `${sign} `), word + more);
  return mark;
}

const $ = (id) => document.getElementById(id);
