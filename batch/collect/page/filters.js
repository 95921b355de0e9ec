/* Which cells are shown: search, states, clip, recipe, and ranges of any column. */

class Filters {
  constructor() {
    this.clear();
  }

  clear() {
    this.text = "";
    this.states = new Set(); // none: all
    this.equal = new Map(); // column's key: what cells have there
    this.ranges = new Map(); // column's key: [from, to], either may be null
  }

  /** Indices of the cells that pass, in the batch's order. */
  matching() {
    const tests = [];
    if (this.states.size) tests.push((i) => this.states.has(stateOf(i)));
    for (const [key, wanted] of this.equal) {
      const { at } = byKey.get(key);
      tests.push((i) => at(i) !== null && String(at(i)) === wanted);
    }
    for (const [key, [from, to]] of this.ranges) {
      if (from === null && to === null) continue;
      const { at } = byKey.get(key);
      tests.push((i) => at(i) !== null && at(i) >= (from ?? -Infinity) && at(i) <= (to ?? Infinity));
    }
    const words = folded(this.text).split(/\s+/).filter(Boolean);
    if (words.length) {
      tests.push((i) => words.every((word) => haystacks()[i].includes(word)));
    }
    return order.filter((i) => tests.every((test) => test(i)));
  }

  get any() {
    return Boolean(this.text || this.states.size || this.equal.size || this.ranges.size);
  }

  /** As the page's address keeps it. */
  save(to) {
    if (this.text) to.set("search", this.text);
    for (const state of this.states) to.append("state", state);
    for (const [key, wanted] of this.equal) to.set(`is:${key}`, wanted);
    for (const [key, [low, high]] of this.ranges) to.set(`in:${key}`, `${low ?? ""}~${high ?? ""}`);
  }

  load(from) {
    this.clear();
    this.text = from.get("search") ?? "";
    for (const state of from.getAll("state")) if (STATES.has(state)) this.states.add(state);
    for (const [name, value] of from) {
      const kind = name.slice(0, 3);
      const key = name.slice(3);
      if (!byKey.has(key)) continue;
      if (kind === "is:") this.equal.set(key, value);
      if (kind === "in:" && byKey.get(key).number) this.ranges.set(key, value.split("~").map(numberOr));
    }
  }
}

/** Letters without case and width, so that half a name finds it however it was typed. */
const folded = (text) => text.normalize("NFKC").toLowerCase();
const numberOr = (text) => (text === undefined || text.trim() === "" || Number.isNaN(Number(text)) ? null : Number(text));

let searched = null;
function haystacks() {
  const told = [...columns.filter((column) => !column.number), ...values];
  searched ??= order.map((i) => folded(
    [batch.cells[i], ...told.map((column) => column.text(i)), variation(i)].join("\n")));
  return searched;
}

/** The controls of the filters. `changed` is called after each change. */
class FilterBar {
  constructor(filters, changed) {
    this.filters = filters;
    this.changed = changed;
    $("text").addEventListener("input", () => {
      filters.text = $("text").value;
      changed();
    });
    for (const key of ["clip", "recipe"]) {
      $(key).append(new Option("All", ""), ...byKey.get(key).distinct.map((name) => new Option(name, name)));
      $(key).addEventListener("change", () => this.setEqual(key, $(key).value));
    }
    this.stateButtons = [...STATES.keys()].map((state) => {
      const count = batch.state.filter((k) => batch.states[k] === state).length;
      const button = make("button", { type: "button", data: { state }, hidden: count === 0 });
      button.append(stateMark(state, ` ${count.toLocaleString("en")}`));
      button.addEventListener("click", () => {
        if (!filters.states.delete(state)) filters.states.add(state);
        this.show();
        changed();
      });
      return button;
    });
    $("states").append(...this.stateButtons);
    $("more").append(new Option("Choose…", ""));
    for (const [label, members] of [["Values", values], ["Figures", figures]]) {
      const group = make("optgroup", { label });
      group.append(...members.filter(varies).map((column) => new Option(column.name, column.key)));
      if (group.children.length) $("more").append(group);
    }
    $("more").append(new Option("Time (s)", "seconds"));
    $("more").addEventListener("change", () => {
      const column = byKey.get($("more").value);
      $("more").value = "";
      if (column === undefined) return;
      if (column.number) filters.ranges.set(column.key, filters.ranges.get(column.key) ?? [null, null]);
      else filters.equal.set(column.key, String(column.distinct[0]));
      this.show();
      changed();
      $("ranges").querySelector(`fieldset[data-key="${CSS.escape(column.key)}"] :is(input, select)`).focus();
    });
    $("clear").addEventListener("click", () => {
      filters.clear();
      this.show();
      changed();
    });
  }

  setEqual(key, value) {
    if (value) this.filters.equal.set(key, value);
    else this.filters.equal.delete(key);
    this.changed();
  }

  /** Put the filters into the controls. */
  show() {
    const { text, states, equal, ranges } = this.filters;
    if ($("text").value !== text) $("text").value = text;
    for (const key of ["clip", "recipe"]) $(key).value = equal.get(key) ?? "";
    for (const button of this.stateButtons) {
      button.setAttribute("aria-pressed", String(states.has(button.dataset.state)));
    }
    const boxes = [...ranges.keys()].map((key) => this.rangeBox(byKey.get(key)));
    const others = [...equal.keys()].filter((key) => !["clip", "recipe"].includes(key));
    boxes.push(...others.map((key) => this.choiceBox(byKey.get(key))));
    $("ranges").replaceChildren(...boxes);
    $("ranges").hidden = boxes.length === 0;
  }

  box(column, ...held) {
    const away = make("button", { type: "button", title: "Remove this filter" }, "✕");
    away.setAttribute("aria-label", `Remove the filter of ${column.name}`);
    away.addEventListener("click", () => {
      this.filters.ranges.delete(column.key);
      this.filters.equal.delete(column.key);
      this.show();
      this.changed();
      $("more").focus();
    });
    return make("fieldset", { data: { key: column.key } }, make("legend", {}, column.name), ...held, away);
  }

  rangeBox(column) {
    const found = column.distinct;
    const [lowest, highest] = [found[0], found[found.length - 1]];
    const range = this.filters.ranges.get(column.key);
    const inputs = ["from", "to"].map((word, end) => {
      const input = make("input", {
        type: "number", step: "any", value: range[end] ?? "", placeholder: `${word} ${written(end ? highest : lowest)}`,
      });
      input.setAttribute("aria-label", `${column.name}, ${word}`);
      input.addEventListener("input", () => {
        range[end] = numberOr(input.value);
        this.changed();
      });
      return input;
    });
    return this.box(column, inputs[0], "to", inputs[1]);
  }

  choiceBox(column) {
    const choice = make("select", {}, ...column.distinct.map((x) => new Option(written(x), String(x))));
    choice.value = this.filters.equal.get(column.key);
    choice.setAttribute("aria-label", column.name);
    choice.addEventListener("change", () => this.setEqual(column.key, choice.value));
    return this.box(column, choice);
  }
}
