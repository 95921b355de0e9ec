/* One cell: its picture and film, what it says of itself, and its files. */

class CellDialog {
  constructor() {
    Object.assign(this, { dialog: $("cell"), shown: [], place: 0 });
    $("close").addEventListener("click", () => this.dialog.close());
    $("before").addEventListener("click", () => this.go(-1));
    $("after").addEventListener("click", () => this.go(1));
    this.dialog.addEventListener("click", (event) => {
      if (event.target === this.dialog) this.dialog.close();
    });
    this.dialog.addEventListener("keydown", (event) => {
      if (event.target.tagName === "VIDEO") return; // its own keys
      if (event.key === "ArrowLeft") this.go(-1);
      if (event.key === "ArrowRight") this.go(1);
    });
    this.dialog.addEventListener("close", () => $("cell-body").replaceChildren()); // ends a film
  }

  /** Open cell i, one of those shown, whose order *Before* and *Next* go through. */
  open(i, shown) {
    this.shown = shown;
    this.place = Math.max(shown.indexOf(i), 0);
    this.fill(i);
    if (!this.dialog.open) this.dialog.showModal();
  }

  go(step) {
    const place = this.place + step;
    if (place < 0 || place >= this.shown.length) return;
    this.place = place;
    this.fill(this.shown[place]);
  }

  fill(i) {
    $("before").disabled = this.place === 0;
    $("after").disabled = this.place >= this.shown.length - 1;
    $("cell-name").textContent = `${i + 1}. ${columns[1].text(i)}`;
    const reason = batch.sentences[batch.sentence[i]];
    const body = [make("p", {}, stateMark(stateOf(i)), ` · ${columns[2].text(i)} · ${batch.cells[i]}`)];
    if (reason) body.push(make("p", { className: "reason" }, reason));
    const media = make("div", { className: "media" });
    if (film(i)) {
      const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
      const source = { src: address(i, film(i)), loop: true, muted: true, autoplay: !still };
      media.append(make("video", { ...source, controls: true, preload: "metadata" }));
    }
    if (picture(i)) {
      const alt = `Recording and adapted motion of ${columns[1].text(i)}`;
      media.append(make("a", { href: picture(i) }, make("img", { src: picture(i), alt })));
    }
    if (media.children.length) body.push(media);
    const facts = [
      this.lines("In short", batch.headlines[i] ?? []),
      this.table("Values", values.filter((column) => column.at(i) !== null), i),
      this.table("Figures", figures.filter((column) => column.at(i) !== null), i),
      this.files(i),
    ];
    body.push(make("div", { className: "facts" }, ...facts.filter(Boolean)));
    $("cell-body").replaceChildren(...body);
  }

  lines(title, told) {
    if (!told.length) return null;
    return make("div", {}, make("h3", {}, title), make("ul", {}, ...told.map((line) => make("li", {}, line))));
  }

  table(title, members, i) {
    if (!members.length) return null;
    const list = make("dl");
    for (const column of members) {
      list.append(make("dt", {}, ...breakable(column.name)), make("dd", {}, column.text(i)));
    }
    return make("div", {}, make("h3", {}, title), list);
  }

  files(i) {
    const names = fileSet(i);
    if (!names.length) return null;
    const links = names.map((name) => make("li", {}, make("a", { href: address(i, name) }, name)));
    return make("div", {}, make("h3", {}, "Files"), make("ul", {}, ...links));
  }
}
