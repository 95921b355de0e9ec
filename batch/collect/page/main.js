/* Puts the page together; what is chosen is kept in its address, so that it can be handed on. */

const MOST_VALUES = 6; // columns of each kind that the table has at first
const MOST_NAMES = 8; // cells that are named beside a reason
const FEW = 3; // cells whose values are told there too

class Page {
  constructor() {
    this.filters = new Filters();
    this.sort = { key: "number", down: false };
    this.hidden = new Set();
    this.pictures = false;
    this.dialog = new CellDialog();
    const open = (i) => this.dialog.open(i, this.shown);
    this.table = new Table(open, (key) => this.sortBy(key));
    this.grid = new Pictures(open);
    this.plot = new Plot(open, (ranges) => this.keep(ranges));
    this.bar = new FilterBar(this.filters, () => this.update());
    this.chooseFirstColumns();
    this.listColumns();
    for (const id of ["as-table", "as-pictures"]) {
      $(id).hidden = !anyPicture;
      $(id).addEventListener("click", () => this.view(id === "as-pictures"));
    }
    document.addEventListener("click", (event) => {
      if (!$("columns").contains(event.target)) $("columns").open = false;
    });
    $("columns").addEventListener("keydown", (event) => {
      if (event.key !== "Escape") return;
      $("columns").open = false;
      $("columns").firstElementChild.focus();
    });
    window.addEventListener("hashchange", () => this.load());
    head();
    problems(this);
    this.load();
  }

  chooseFirstColumns() {
    const kept = [...values.filter(varies).slice(0, MOST_VALUES), ...figures.filter(varies).slice(0, MOST_VALUES)];
    for (const column of [...values, ...figures]) if (!kept.includes(column)) this.hidden.add(column.key);
    if (!varies(byKey.get("recipe"))) this.hidden.add("recipe");
  }

  listColumns() {
    $("column-list").append(...tabled.map((column) => {
      const input = make("input", { type: "checkbox", checked: !this.hidden.has(column.key) });
      input.addEventListener("change", () => {
        if (input.checked) this.hidden.delete(column.key);
        else this.hidden.add(column.key);
        this.drawTable();
      });
      return make("label", {}, input, make("span", {}, ...breakable(column.name)));
    }));
  }

  sortBy(key) {
    const again = this.sort.key === key;
    this.sort = { key, down: again ? !this.sort.down : false };
    this.update();
  }

  /** Keep what a rectangle in the plot bounds. */
  keep(ranges) {
    for (const [key, range] of ranges ?? []) this.filters.ranges.set(key, range);
    if (ranges) this.bar.show();
    this.update();
  }

  view(pictures) {
    this.pictures = pictures;
    $("as-table").setAttribute("aria-pressed", String(!pictures));
    $("as-pictures").setAttribute("aria-pressed", String(pictures));
    $("columns").hidden = pictures;
    this.update();
  }

  update() {
    const shown = this.filters.matching();
    const { at } = byKey.get(this.sort.key);
    const way = this.sort.down ? -1 : 1;
    if (this.sort.key !== "number" || this.sort.down) {
      shown.sort((a, b) => {
        const [x, y] = [at(a), at(b)];
        if (x === null || y === null) return (x === null) - (y === null) || a - b; // missing ones last
        return way * compared(x, y) || a - b;
      });
    }
    this.shown = shown;
    const all = batch.cells.length;
    $("count").textContent = shown.length === all ? counted(all, "cell", "cells")
      : `${shown.length.toLocaleString("en")} of ${counted(all, "cell", "cells")}`;
    $("clear").disabled = !this.filters.any;
    $("none").hidden = shown.length > 0;
    $("table-box").hidden = this.pictures || !shown.length;
    $("pictures-box").hidden = !this.pictures || !shown.length;
    this.drawTable();
    this.grid.set(shown);
    this.plot.set(shown);
    this.save();
  }

  drawTable() {
    this.table.choose(tabled.filter((column) => !this.hidden.has(column.key)), this.sort, anyPicture);
    this.table.set(this.shown);
  }

  save() {
    const kept = new URLSearchParams();
    this.filters.save(kept);
    if (this.sort.key !== "number" || this.sort.down) kept.set("sort", (this.sort.down ? "-" : "") + this.sort.key);
    if (this.pictures) kept.set("view", "pictures");
    for (const id of ["x", "y", "colour"]) if ($(id).value !== $(id).dataset.first) kept.set(id, $(id).value);
    for (const id of ["logx", "logy"]) if ($(id).checked) kept.set(id, "1");
    this.saved = kept.toString();
    history.replaceState(null, "", `#${this.saved}`);
  }

  load() {
    const told = location.hash.slice(1);
    if (told === this.saved) return;
    const kept = new URLSearchParams(told);
    this.filters.load(kept);
    const sort = kept.get("sort") ?? "number";
    const key = sort.replace(/^-/, "");
    this.sort = byKey.has(key) ? { key, down: sort.startsWith("-") } : { key: "number", down: false };
    for (const id of ["x", "y", "colour"]) {
      $(id).value = kept.get(id) ?? $(id).dataset.first;
      if ($(id).selectedIndex < 0) $(id).value = $(id).dataset.first; // of another batch
    }
    for (const id of ["logx", "logy"]) $(id).checked = kept.has(id);
    this.bar.show();
    this.view(kept.get("view") === "pictures" && anyPicture);
  }
}

/** What the batch is, in a line or two. */
function head() {
  const seconds = batch.seconds.reduce((sum, x) => sum + (x ?? 0), 0);
  $("summary").textContent = [
    counted(batch.cells.length, "cell", "cells"), counted(batch.clips.length, "clip", "clips"),
    counted(batch.recipes.length, "recipe", "recipes"), `${lasting(seconds)} of work`,
    `collected ${batch.collected}`, `Hangtime ${batch.version}`,
  ].join(" · ");
  $("notes").textContent = batch.notes.join(" ");
}

/** The cells that ended otherwise than done, by their reasons, of which those that differ in numbers
    alone are one; the reason that most have first. */
function problems(page) {
  const kindOf = byKey.get("reason").at;
  const reasons = new Map();
  for (const i of order) {
    const state = stateOf(i);
    if (!PROBLEMS.includes(state)) continue;
    const why = batch.sentences[batch.sentence[i]] || "It tells no reason; see its log.txt.";
    const key = `${state} ${kindOf(i)}`;
    if (!reasons.has(key)) reasons.set(key, { state, why, cells: [] });
    reasons.get(key).cells.push(i);
  }
  const found = [...reasons.values()].sort((a, b) => b.cells.length - a.cells.length);
  const total = found.reduce((sum, reason) => sum + reason.cells.length, 0);
  $("problems").hidden = total === 0;
  $("problems-heading").textContent = `${counted(total, "cell", "cells")} without a result`;
  $("reasons").append(...found.map(({ state, why, cells }) => {
    const named = (i) => `${i + 1}. ${columns[1].text(i)}`;
    const texts = new Set(cells.map((i) => batch.sentence[i])).size;
    const told = texts > 1 ? `${why} (And the like, with other numbers.)` : why;
    const names = cells.slice(0, MOST_NAMES).map(
      (i) => (cells.length <= FEW && variation(i) ? `${named(i)}: ${variation(i)}` : named(i)));
    if (cells.length > MOST_NAMES) names.push(`and ${(cells.length - MOST_NAMES).toLocaleString("en")} more`);
    const show = make("button", { type: "button" }, cells.length === 1 ? "Open" : `Show ${cells.length.toLocaleString("en")}`);
    show.setAttribute("aria-label", cells.length === 1 ? `Open cell ${cells[0] + 1}` : `Show the ${cells.length} cells: ${why}`);
    show.addEventListener("click", () => {
      if (cells.length === 1) {
        page.dialog.open(cells[0], cells);
        return;
      }
      page.filters.clear();
      page.filters.states.add(state);
      page.filters.equal.set("reason", kindOf(cells[0]));
      page.bar.show();
      page.update();
      $("cells-heading").focus();
      $("cells").scrollIntoView();
    });
    return make("li", {}, stateMark(state), make("span", { className: "why" }, told), show, make("span", { className: "names" }, names.join(" · ")));
  }));
}

new Page();
(window.requestIdleCallback ?? setTimeout)(() => haystacks()); // so that the first search is quick too
document.documentElement.dataset.ready = String(Math.round(performance.now()));
