/* The table and the pictures: of thousands of cells only those in sight are in the document. */

const OVERSCAN = 8; // lines drawn above and below those in sight

/** A scrolled box of lines of equal height. Holds `shown` cells, `active` is the place of one. */
class ScrolledCells {
  constructor(box, focused, open) {
    Object.assign(this, { box, focused, open, shown: [], active: 0, perLine: 1, drawn: "" });
    box.addEventListener("scroll", () => this.draw(), { passive: true });
    focused.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.resized()).observe(box);
  }

  resized() {
    this.draw(true);
  }

  set(shown) {
    const cell = this.shown[this.active];
    this.shown = shown;
    this.active = Math.max(shown.indexOf(cell), 0);
    this.box.scrollTop = 0;
    this.draw(true);
  }

  get lines() {
    return Math.ceil(this.shown.length / this.perLine);
  }

  /** Draw the lines in sight, where they are not drawn yet. */
  draw(anyway = false) {
    if (this.box.hidden) return;
    const top = Math.floor(this.box.scrollTop / this.lineHeight) - OVERSCAN;
    const count = Math.ceil(this.box.clientHeight / this.lineHeight) + 2 * OVERSCAN;
    const first = Math.max(Math.min(top - (top % OVERSCAN), this.lines - count), 0);
    const last = Math.min(first + count + OVERSCAN, this.lines);
    const range = `${first}-${last}`;
    if (range === this.drawn && !anyway) return;
    this.drawn = range;
    this.fill(first, last);
    this.mark();
  }

  /** Show which one is active. */
  mark() {
    for (const element of this.box.querySelectorAll(".active")) {
      element.classList.remove("active");
      element.setAttribute("aria-selected", "false");
    }
    const element = this.box.querySelector(`[data-place="${this.active}"]`);
    element?.classList.add("active");
    element?.setAttribute("aria-selected", "true");
    if (element) this.focused.setAttribute("aria-activedescendant", element.id);
    else this.focused.removeAttribute("aria-activedescendant");
  }

  go(place) {
    if (!this.shown.length) return;
    this.active = Math.min(Math.max(place, 0), this.shown.length - 1);
    const line = Math.floor(this.active / this.perLine) * this.lineHeight;
    const sight = this.box.clientHeight - this.headHeight;
    if (line < this.box.scrollTop) this.box.scrollTop = line;
    if (line + this.lineHeight > this.box.scrollTop + sight) {
      this.box.scrollTop = line + this.lineHeight - sight;
    }
    this.draw();
    this.mark();
  }

  key(event) {
    if (event.target !== this.focused || event.ctrlKey || event.metaKey || event.altKey) return;
    const page = Math.max(Math.floor(this.box.clientHeight / this.lineHeight) - 1, 1) * this.perLine;
    const across = this.perLine > 1 ? { ArrowLeft: -1, ArrowRight: 1 } : {};
    const steps = { ArrowDown: this.perLine, ArrowUp: -this.perLine, PageDown: page, PageUp: -page, ...across };
    if (event.key in steps) this.go(this.active + steps[event.key]);
    else if (event.key === "Home") this.go(0);
    else if (event.key === "End") this.go(this.shown.length - 1);
    else if (event.key === "Enter" && this.shown.length) this.open(this.shown[this.active]);
    else return;
    event.preventDefault();
  }

  /** Of a row or tile: chosen and opened by the mouse. */
  opens(element, place) {
    element.id = `${this.focused.id}-${place}`;
    element.dataset.place = place;
    element.addEventListener("click", () => {
      this.go(place);
      this.open(this.shown[place]);
    });
    return element;
  }
}

class Table extends ScrolledCells {
  constructor(open, sorted) {
    super($("table-box"), $("table"), open);
    this.sorted = sorted;
    this.columns = [];
  }

  get lineHeight() {
    return this.pictured ? 72 : 36;
  }

  get headHeight() {
    return $("heads").offsetHeight;
  }

  /** Which columns, and by which one they are sorted. */
  choose(chosen, sort, pictured) {
    this.columns = chosen;
    this.pictured = pictured;
    this.box.style.setProperty("--row", `${this.lineHeight}px`);
    const heads = chosen.map((column) => {
      const direction = sort.key === column.key ? (sort.down ? "descending" : "ascending") : "none";
      const button = make("button", { type: "button", title: `Sort by ${column.name}` }, ...breakable(column.name));
      if (column.group) button.prepend(make("small", {}, column.group === "value" ? "value" : "figure"));
      if (direction !== "none") button.append(sort.down ? " ▼" : " ▲");
      button.addEventListener("click", () => this.sorted(column.key));
      const head = make("th", { scope: "col", className: column.number ? "number" : "", aria: { role: "columnheader", sort: direction } }, button);
      head.style.width = `${widthOf(column)}px`;
      return head;
    });
    if (pictured) {
      const head = make("th", { scope: "col", aria: { role: "columnheader" } }, make("button", { type: "button", disabled: true }, "Picture"));
      head.style.width = "136px";
      heads.unshift(head);
    }
    const focused = [...$("heads").children].findIndex((head) => head.contains(document.activeElement));
    $("heads").replaceChildren(...heads);
    $("heads").setAttribute("aria-rowindex", "1");
    $("table").setAttribute("aria-colcount", String(heads.length));
    $("table").style.width = `${heads.reduce((sum, head) => sum + parseInt(head.style.width, 10), 0)}px`;
    if (focused >= 0) heads[Math.min(focused, heads.length - 1)].querySelector("button").focus();
  }

  fill(first, last) {
    $("table").setAttribute("aria-rowcount", String(this.shown.length + 1));
    const rows = [this.space(first)];
    for (let place = first; place < last; place += 1) rows.push(this.row(place));
    rows.push(this.space(this.lines - last));
    $("rows").replaceChildren(...rows);
  }

  space(lines) {
    const space = make("tr", { className: "space", aria: { hidden: "true" } });
    space.style.height = `${lines * this.lineHeight}px`;
    return space;
  }

  row(place) {
    const i = this.shown[place];
    const row = make("tr", { aria: { role: "row", rowindex: String(place + 2) } });
    if (this.pictured) row.append(make("td", { aria: { role: "gridcell" } }, shot(i)));
    for (const column of this.columns) {
      const cell = make("td", { className: column.number ? "number" : "", aria: { role: "gridcell" } });
      const text = column.text(i);
      cell.append(column.key === "state" ? stateMark(column.at(i)) : text);
      if (!column.number) cell.title = text;
      row.append(cell);
    }
    return this.opens(row, place);
  }
}

class Pictures extends ScrolledCells {
  constructor(open) {
    super($("pictures-box"), $("pictures-box"), open);
    this.sizer = make("div", { aria: { role: "presentation" } });
    this.tiles = make("div", { className: "tiles", aria: { role: "presentation" } });
    this.box.append(this.sizer, this.tiles);
  }

  get lineHeight() {
    return 280;
  }

  get headHeight() {
    return 0;
  }

  resized() {
    this.perLine = Math.max(Math.floor(this.box.clientWidth / 300), 1);
    super.resized();
  }

  fill(first, last) {
    this.sizer.style.height = `${this.lines * this.lineHeight}px`;
    this.tiles.style.top = `${first * this.lineHeight}px`;
    this.tiles.style.gridTemplateColumns = `repeat(${this.perLine}, minmax(0, 1fr))`;
    const places = [];
    for (let place = first * this.perLine; place < Math.min(last * this.perLine, this.shown.length); place += 1) {
      places.push(this.tile(place));
    }
    this.tiles.replaceChildren(...places);
  }

  tile(place) {
    const i = this.shown[place];
    const words = make("div", { className: "words" },
      make("div", { title: columns[1].text(i) }, `${i + 1}. ${columns[1].text(i)}`),
      make("div", { className: "quiet" }, variation(i) || columns[2].text(i)));
    if (stateOf(i) !== "done") words.append(make("div", {}, stateMark(stateOf(i))));
    const held = shot(i) || "No picture";
    const tile = make("div", { className: "tile", aria: { role: "option", setsize: String(this.shown.length), posinset: String(place + 1) } },
      make("div", { className: "shot" }, held), words);
    return this.opens(tile, place);
  }
}

function shot(i) {
  const source = picture(i);
  return source ? make("img", { loading: "lazy", decoding: "async", alt: "", src: source }) : "";
}

/** A long name that may go on in the next line after a dot or an underscore. */
function breakable(name) {
  return name.split(/(?<=[._])/).flatMap((part, k) => (k ? [make("wbr"), part] : [part]));
}

function widthOf(column) {
  if (column.key === "number") return 78;
  if (column.key === "state") return 132;
  if (column.key === "outcome") return 420;
  if (column.number) return 118;
  const longest = Math.max(...column.distinct.map((x) => String(x).length), 6);
  return Math.min(Math.max(8.6 * longest + 24, 100), 300);
}
