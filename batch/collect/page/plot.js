/* What varies against what came out, cell by cell. */

const PREFERRED = { y: "figure:peak_force_bw" }; // at first, where there is such a figure
const PALETTE = ["#3b82d8", "#df7f00", "#1f9e77", "#d6407c", "#8a63d2", "#a88300", "#0aa0b4", "#7f9128", "#b9643f"];
const OTHERS = "#8a8f98";
const EDGE = { left: 68, right: 14, top: 12, bottom: 46 };
const NEAR = 14; // pixels from a point that the mouse still finds it

class Plot {
  constructor(open, chosen) {
    Object.assign(this, { open, canvas: $("canvas"), shown: [], points: [], at: -1, drag: null });
    const numbers = (members) => members.filter((column) => column.number && varies(column));
    const across = [...numbers(values), ...numbers(figures), byKey.get("seconds"), byKey.get("number")];
    const up = [...numbers(figures), byKey.get("seconds"), ...numbers(values)];
    const coloured = [byKey.get("clip"), byKey.get("recipe"), byKey.get("state"), ...values.filter((c) => varies(c) && c.distinct.length <= 30)];
    for (const [id, members] of [["x", across], ["y", up], ["colour", coloured]]) {
      $(id).append(...members.map((column) => new Option(column.name, column.key)));
      const preferred = members.find((column) => column.key === PREFERRED[id]) ?? members[0];
      $(id).dataset.first = preferred.key;
      $(id).addEventListener("change", () => this.changed(chosen));
    }
    for (const id of ["logx", "logy"]) $(id).addEventListener("change", () => this.changed(chosen));
    this.listen(chosen);
    $("plot").addEventListener("toggle", () => this.draw());
    new ResizeObserver(() => this.draw()).observe($("canvas-box"));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }

  changed(chosen) {
    this.draw();
    chosen(null);
  }

  listen(chosen) {
    const { canvas } = this;
    const place = (event) => {
      const box = canvas.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    canvas.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      canvas.setPointerCapture(event.pointerId);
      this.drag = { from: place(event), to: place(event) };
    });
    canvas.addEventListener("pointermove", (event) => {
      if (this.drag) {
        this.drag.to = place(event);
        this.draw();
      } else this.point(this.nearest(...place(event)));
    });
    canvas.addEventListener("pointerup", (event) => {
      if (!this.drag) return;
      const { from, to } = this.drag;
      this.drag = null;
      if (Math.hypot(from[0] - to[0], from[1] - to[1]) < 5) {
        const found = this.nearest(...place(event));
        if (found >= 0) this.open(this.points[found].i);
      } else chosen(this.ranges(from, to));
      this.draw();
    });
    canvas.addEventListener("pointercancel", () => this.letGo());
    canvas.addEventListener("pointerleave", () => { if (!this.drag) this.point(-1); });
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  letGo() {
    this.drag = null;
    this.draw();
  }

  key(event) {
    const step = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
    if (step && this.points.length) {
      const along = this.points.map((_, k) => k).sort((a, b) => this.points[a].x - this.points[b].x || this.points[b].y - this.points[a].y);
      const now = along.indexOf(this.at);
      this.point(along[(now + step + along.length) % along.length]);
    } else if (event.key === "Enter" && this.at >= 0) this.open(this.points[this.at].i);
    else if (event.key === "Escape" && this.drag) this.letGo();
    else return;
    event.preventDefault();
  }

  set(shown) {
    this.shown = shown;
    this.at = -1;
    $("tip").textContent = "";
    this.draw();
  }

  told(i) {
    const [x, y] = [byKey.get($("x").value), byKey.get($("y").value)];
    return [`${i + 1}. ${columns[1].text(i)}, ${columns[2].text(i)}`, variation(i),
      `${x.name}: ${x.text(i)}`, `${y.name}: ${y.text(i)}`].filter(Boolean).join("\n");
  }

  /** Colour and shape of what shown cells have: of those that most have, the others are grey. */
  classes(column) {
    const counts = new Map();
    for (const i of this.shown) counts.set(column.at(i), (counts.get(column.at(i)) ?? 0) + 1);
    const known = [...counts.keys()].sort((a, b) => counts.get(b) - counts.get(a)).slice(0, PALETTE.length);
    if (counts.size <= PALETTE.length) known.sort(compared);
    this.others = counts.size - known.length;
    return new Map(known.map((name, k) => [name, { colour: PALETTE[k], shape: k % SHAPES.length }]));
  }

  draw() {
    if (!$("plot").open || !$("x").value || !$("y").value) return;
    const box = $("canvas-box").getBoundingClientRect();
    const [wide, high, dense] = [Math.round(box.width), 340, window.devicePixelRatio || 1];
    if (wide < 10) return;
    Object.assign(this.canvas, { width: wide * dense, height: high * dense });
    const pen = this.canvas.getContext("2d");
    pen.scale(dense, dense);
    const style = getComputedStyle(document.documentElement);
    const ink = (name) => style.getPropertyValue(`--${name}`).trim();
    const [x, y, colour] = ["x", "y", "colour"].map((id) => byKey.get($(id).value));
    const logs = [$("logx").checked, $("logy").checked];
    const there = this.shown.filter((i) => x.at(i) !== null && y.at(i) !== null);
    const drawable = there.filter((i) => (!logs[0] || x.at(i) > 0) && (!logs[1] || y.at(i) > 0));
    this.tell(this.shown.length - there.length, there.length - drawable.length);
    this.scales = [
      new Scale(drawable.map(x.at), logs[0], EDGE.left, wide - EDGE.right),
      new Scale(drawable.map(y.at), logs[1], high - EDGE.bottom, EDGE.top),
    ];
    this.axes(pen, ink, wide, high, x, y);
    const classes = this.classes(colour);
    this.points = drawable.map((i) => (
      { i, x: this.scales[0].place(x.at(i)), y: this.scales[1].place(y.at(i)), ...classes.get(colour.at(i)) }));
    pen.globalAlpha = this.points.length > 2000 ? 0.55 : 0.85;
    const size = this.points.length > 2000 ? 3 : 4.5;
    for (const point of this.points) if (!point.colour) symbol(pen, point, size); // the others below
    for (const point of this.points) if (point.colour) symbol(pen, point, size);
    pen.globalAlpha = 1;
    const now = this.points[this.at];
    if (now) {
      pen.strokeStyle = ink("ink");
      pen.lineWidth = 2;
      pen.beginPath();
      pen.arc(now.x, now.y, 9, 0, 2 * Math.PI);
      pen.stroke();
    }
    if (this.drag) {
      const { from, to } = this.drag;
      pen.strokeStyle = ink("accent");
      pen.lineWidth = 1.5;
      pen.setLineDash([5, 4]);
      pen.strokeRect(from[0], from[1], to[0] - from[0], to[1] - from[1]);
    }
    this.legend(colour, classes);
    this.canvas.setAttribute("aria-label",
      `${y.name} against ${x.name} of ${counted(this.points.length, "cell", "cells")}, coloured by ${colour.name.toLowerCase()}`);
  }

  axes(pen, ink, wide, high, x, y) {
    pen.font = "12px system-ui, sans-serif";
    pen.lineWidth = 1;
    pen.strokeStyle = ink("line");
    pen.fillStyle = ink("quiet");
    pen.textAlign = "center";
    for (const { value, text } of this.scales[0].ticks((wide - EDGE.left) / 90)) {
      const at = Math.round(this.scales[0].place(value)) + 0.5;
      stroke(pen, at, EDGE.top, at, high - EDGE.bottom);
      pen.fillText(text, at, high - EDGE.bottom + 16);
    }
    pen.textAlign = "right";
    for (const { value, text } of this.scales[1].ticks(6)) {
      const at = Math.round(this.scales[1].place(value)) + 0.5;
      stroke(pen, EDGE.left, at, wide - EDGE.right, at);
      pen.fillText(text, EDGE.left - 7, at + 4);
    }
    pen.fillStyle = ink("ink");
    pen.font = "600 13px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.fillText(x.name, (EDGE.left + wide - EDGE.right) / 2, high - 8, wide - 100);
    pen.save();
    pen.translate(14, (EDGE.top + high - EDGE.bottom) / 2);
    pen.rotate(-Math.PI / 2);
    pen.fillText(y.name, 0, 0, high - 60);
    pen.restore();
  }

  tell(missing, below) {
    const told = [];
    if (missing) told.push(`${counted(missing, "cell has", "cells have")} no figure here`);
    if (below) told.push(`${counted(below, "cell is", "cells are")} not above zero, so not on a logarithmic axis`);
    $("left-out").textContent = told.join("; ");
  }

  legend(column, classes) {
    const items = [...classes].map(([name, look]) => {
      const sign = make("canvas", { width: 28, height: 28, aria: { hidden: "true" } });
      sign.style.width = "14px";
      const pen = sign.getContext("2d");
      pen.scale(2, 2);
      symbol(pen, { x: 7, y: 7, ...look }, 5);
      return make("li", {}, sign, column.key === "state" ? STATES.get(name).word : written(name));
    });
    if (this.others) items.push(make("li", { className: "quiet" }, `grey: ${counted(this.others, "other", "others")}`));
    $("legend").replaceChildren(...items);
  }

  /** The points' place of the nearest one, -1 where none is near. */
  nearest(x, y) {
    let found = -1;
    let least = NEAR ** 2;
    this.points.forEach((point, k) => {
      const far = (point.x - x) ** 2 + (point.y - y) ** 2;
      if (far <= least) [found, least] = [k, far];
    });
    return found;
  }

  /** Ring a point and tell what it is. */
  point(k) {
    if (k === this.at) return;
    this.at = k;
    this.draw();
    const tip = $("tip");
    tip.textContent = "";
    if (k < 0) return;
    const { i, x, y } = this.points[k];
    tip.textContent = this.told(i);
    const room = this.canvas.clientWidth - tip.offsetWidth - 6;
    tip.style.left = `${Math.max(Math.min(x + 14, room), 0)}px`;
    tip.style.top = `${Math.min(y + 14, 340 - tip.offsetHeight)}px`;
  }

  /** What two corners of a rectangle bound, by the columns' keys. */
  ranges(from, to) {
    return ["x", "y"].map((id, k) => {
      const ends = [this.scales[k].value(from[k]), this.scales[k].value(to[k])].sort((a, b) => a - b);
      return [$(id).value, ends.map((end) => Number(end.toPrecision(4)))];
    });
  }
}

/** Values to pixels and back, from `start` to `end`, linear or logarithmic. */
class Scale {
  constructor(found, log, start, end) {
    Object.assign(this, { log, start, end });
    let low = Infinity;
    let high = -Infinity;
    for (const value of found) [low, high] = [Math.min(low, value), Math.max(high, value)];
    if (low > high) [low, high] = log ? [1, 10] : [0, 1];
    [low, high] = [this.bent(low), this.bent(high)];
    const margin = (high - low || Math.abs(high) || 1) * 0.05;
    [this.low, this.high] = [low - margin, high + margin];
  }

  bent(value) {
    return this.log ? Math.log10(value) : value;
  }

  place(value) {
    return this.start + ((this.bent(value) - this.low) / (this.high - this.low)) * (this.end - this.start);
  }

  value(place) {
    const bent = this.low + ((place - this.start) / (this.end - this.start)) * (this.high - this.low);
    return this.log ? 10 ** bent : bent;
  }

  /** About so many round values. */
  ticks(count) {
    const found = [];
    if (this.log && this.high - this.low > 0.8) {
      const factors = this.high - this.low > 3 ? [1] : [1, 2, 5];
      for (let decade = Math.floor(this.low); decade <= this.high; decade += 1) {
        found.push(...factors.map((factor) => Number((factor * 10 ** decade).toPrecision(1))));
      }
    } else {
      const [low, high] = this.log ? [10 ** this.low, 10 ** this.high] : [this.low, this.high];
      const rough = (high - low) / Math.max(count, 2);
      const decade = 10 ** Math.floor(Math.log10(rough));
      const step = [1, 2, 5, 10].find((factor) => factor * decade >= rough) * decade;
      for (let k = Math.ceil(low / step); k * step <= high; k += 1) found.push(Number((k * step).toPrecision(10)));
    }
    const inside = found.filter((value) => this.bent(value) >= this.low && this.bent(value) <= this.high);
    return inside.map((value) => ({ value, text: String(value) }));
  }
}

const SHAPES = [
  (pen, r) => pen.arc(0, 0, r, 0, 2 * Math.PI),
  (pen, r) => pen.rect(-0.88 * r, -0.88 * r, 1.76 * r, 1.76 * r),
  (pen, r) => polygon(pen, [[0, -1.2 * r], [1.1 * r, 0.8 * r], [-1.1 * r, 0.8 * r]]),
  (pen, r) => polygon(pen, [[0, -1.25 * r], [1.25 * r, 0], [0, 1.25 * r], [-1.25 * r, 0]]),
  (pen, r) => polygon(pen, [[0, 1.2 * r], [1.1 * r, -0.8 * r], [-1.1 * r, -0.8 * r]]),
];

function symbol(pen, { x, y, colour = OTHERS, shape = 0 }, size) {
  pen.fillStyle = colour;
  pen.translate(x, y);
  pen.beginPath();
  SHAPES[shape](pen, size);
  pen.fill();
  pen.translate(-x, -y);
}

function polygon(pen, corners) {
  corners.forEach(([x, y], k) => (k ? pen.lineTo(x, y) : pen.moveTo(x, y)));
  pen.closePath();
}

function stroke(pen, x1, y1, x2, y2) {
  pen.beginPath();
  pen.moveTo(x1, y1);
  pen.lineTo(x2, y2);
  pen.stroke();
}
