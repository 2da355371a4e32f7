// Plots over time. All share one View: the range of time that is shown and the cursor.

const COLOURS = {};
function readColours() {
  const style = getComputedStyle(document.documentElement), of = name => style.getPropertyValue(name).trim();
  Object.assign(COLOURS, {ink: of("--ink"), quiet: of("--quiet"), line: of("--line"), warn: of("--warn"), bad: of("--bad"),
    good: of("--good"), card: of("--card"), font: of("--font"),
    logs: [of("--after"), of("--before")], second: of("--held"),
    gauges: [of("--after"), of("--before"), of("--held"), of("--fourth"), of("--warn"), of("--bad")]});
}

// The context of a canvas, cleared and as large as its element; units are CSS pixels.
function prepared(canvas) {
  const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const g = canvas.getContext("2d");
  g.setTransform(ratio, 0, 0, ratio, 0, 0);
  g.clearRect(0, 0, width, height);
  return {g, width, height};
}

class View {
  constructor() { this.t0 = 0; this.t1 = 1; this.least = 0; this.most = 1; this.cursor = 0; }
  bounds(least, most) { this.least = least; this.most = most > least ? most : least + 1; }
  all() { this.t0 = this.least; this.t1 = this.most; }
  zoom(factor, about) {
    const span = Math.min(this.most - this.least, Math.max((this.most - this.least) * 1e-7, (this.t1 - this.t0) * factor));
    const share = (about - this.t0) / (this.t1 - this.t0);
    this.show(about - share * span, span);
  }
  show(t0, span) {
    this.t0 = Math.max(this.least, Math.min(this.most - span, t0));
    this.t1 = this.t0 + span;
  }
  // Moves the range so that the cursor is in it, by a page: what moves with every frame is drawn with every frame.
  include(t) {
    const span = this.t1 - this.t0;
    if (t < this.t0 || t > this.t1) this.show(t < this.t0 ? t - 0.95 * span : t - 0.05 * span, span);
  }
}

const LEFT = 56, RIGHT = 8, TOP = 5, BOTTOM = 7;

function niceStep(span, count) {
  const raw = span / count, power = Math.pow(10, Math.floor(Math.log10(raw)));
  return power * [1, 2, 5, 10].find(step => step * power >= raw * 0.999999);
}

function timeText(t, step) {
  if (t > 1e9) return new Date(t * 1000).toISOString().slice(11, step < 1 ? 23 : 19);
  return t.toFixed(Math.max(0, Math.min(6, Math.ceil(-Math.log10(step)))));
}

// One plot. `spec`: {title, unit, height, kind, series(log, k)}; a series is
// {name, label, colour, dash, below, above, std}.
class Plot {
  constructor(parent, spec, view) {
    this.spec = spec;
    this.view = view;
    this.element = document.createElement("div");
    this.element.className = "plot";
    this.head = document.createElement("div");
    this.head.className = "head";
    this.area = document.createElement("div");
    this.area.className = "area";
    this.area.style.height = spec.height + "px";
    this.canvas = document.createElement("canvas");
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", spec.title + " over time");
    this.area.append(this.canvas);
    this.element.append(this.head, this.area);
    parent.append(this.element);
  }
  x(t) { return LEFT + (this.width - LEFT - RIGHT) * (t - this.view.t0) / (this.view.t1 - this.view.t0); }
  t(x) { return this.view.t0 + (x - LEFT) / (this.width - LEFT - RIGHT) * (this.view.t1 - this.view.t0); }
  y(value) {
    const {low, high} = this, bottom = this.height - BOTTOM;
    const share = this.spec.kind === "log" ? Math.log(Math.max(value, low) / low) / Math.log(high / low) : (value - low) / (high - low);
    return bottom - (bottom - TOP) * Math.max(-0.02, Math.min(1.02, share));
  }
  setSeries(logs) {
    this.series = [];
    logs.forEach((log, k) => {
      for (const series of this.spec.series(log, k, logs.length)) {
        if (log.channels[series.name]) this.series.push({log, dash: [], ...series});
      }
    });
    this.head.replaceChildren();
    const title = document.createElement("b");
    if (this.spec.kind !== "status") title.textContent = this.spec.title + (this.spec.unit ? ` (${this.spec.unit})` : "");
    this.head.append(title);
    for (const series of this.series) {
      if (!series.label) continue;
      const key = document.createElement("span");
      key.className = "key";
      key.style.setProperty("--colour", series.colour);
      key.style.setProperty("--dash", series.dash.length ? "dashed" : "solid");
      key.textContent = series.label;
      this.head.append(key);
    }
    this.element.hidden = this.series.length === 0 && this.spec.kind !== "status";
  }
  // The columns that a series is drawn from: one for a pixel, or one for a frame where there are fewer.
  columns(series) {
    const {log} = series, {t0, t1} = this.view, columns = [];
    const channel = log.channels[series.name], low = log.channels[series.below], high = log.channels[series.above];
    const std = log.channels[series.std], out = [0, 0];
    const first = Math.max(log.first, log.indexOf(t0) - 1), end = Math.min(log.end, log.indexOf(t1) + 1);
    const add = (x, i, next) => {
      channel.range(i, next, out);
      const column = {x, lo: out[0], hi: out[1], low: NaN, high: NaN, s: 0, mask: log.statusMask(i, next)};
      if (low) { low.range(i, next, out); column.low = column.lo - (isNaN(out[1]) ? 0 : out[1]); }
      if (high) { high.range(i, next, out); column.high = column.hi + (isNaN(out[1]) ? 0 : out[1]); }
      if (std) { std.range(i, next, out); column.s = isNaN(out[1]) ? 0 : out[1]; }
      columns.push(column);
    };
    const pixels = Math.max(1, Math.floor(this.width - LEFT - RIGHT));
    columns.dense = end - first > pixels;
    if (!columns.dense) {
      for (let i = first; i < end; i++) add(this.x(log.time(i)), i, i + 1);
    } else {
      let i = log.indexOf(this.t(LEFT));
      for (let x = LEFT; x < LEFT + pixels; x++) {
        const next = log.indexOf(this.t(x + 1));
        if (next > i) add(x + 0.5, i, next);
        i = next;
      }
    }
    return columns;
  }
  // The range of values that are shown.
  findRange(all) {
    const spec = this.spec;
    if (spec.range) { [this.low, this.high] = spec.range(); return; }
    let low = Infinity, high = -Infinity;
    // Frames that are not observable may be far off; they do not set the scale, unless there are no others.
    const sure = all.map(columns => columns.filter(c => !(c.mask & 4)));
    if (sure.some(columns => columns.some(c => !isNaN(c.lo)))) all = sure;
    for (const columns of all) {
      for (const c of columns) {
        if (c.lo < low) low = c.lo;
        if (c.hi > high) high = c.hi;
      }
    }
    for (const columns of all) {  // bands, but no more than three times as much
      const most = 3 * Math.max(high - low, spec.least || 0), middle = (low + high) / 2;
      for (const c of columns) {
        if (c.low < low) low = Math.max(c.low, middle - most);
        if (c.high > high) high = Math.min(c.high, middle + most);
      }
    }
    if (!(low <= high)) { low = 0; high = 1; }
    if (spec.symmetric) { high = Math.max(spec.least, Math.abs(low), Math.abs(high)); low = -high; }
    if (spec.zero) { low = Math.min(0, low); high = Math.max(spec.least || 0, high); }
    const pad = 0.06 * Math.max(high - low, spec.least || 1e-9);
    this.low = spec.symmetric || (spec.zero && low === 0) ? low : low - pad;
    this.high = spec.symmetric ? high : high + pad;
  }
  axes(g) {
    g.font = `11px ${COLOURS.font}`;
    g.fillStyle = COLOURS.quiet;
    g.strokeStyle = COLOURS.line;
    g.lineWidth = 1;
    g.textAlign = "right";
    const line = (value, text) => {
      const y = Math.round(this.y(value)) + 0.5;
      g.beginPath();
      g.moveTo(LEFT, y);
      g.lineTo(this.width - RIGHT, y);
      g.stroke();
      g.fillText(text, LEFT - 6, y + 4);
    };
    if (this.spec.kind === "log") {
      for (const value of this.spec.ticks) line(value, value < 0.01 && value !== 0.001 ? value.toExponential(0).replace("-", "−") : value);
    } else {
      const step = niceStep(this.high - this.low, Math.max(4, this.height / 24));
      const places = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9));
      for (let v = Math.ceil(this.low / step - 1e-9) * step; v <= this.high + 1e-9 * step; v += step) {
        line(v, v.toFixed(places).replace("-", "−").replace(/^−(0\.?0*)$/, "$1"));
      }
    }
    const span = this.view.t1 - this.view.t0, step = niceStep(span, Math.max(2, (this.width - LEFT) / 90));
    g.textAlign = "center";
    for (let t = Math.ceil(this.view.t0 / step) * step; t <= this.view.t1; t += step) {
      const x = Math.round(this.x(t)) + 0.5;
      g.beginPath();
      g.moveTo(x, TOP);
      g.lineTo(x, this.height - BOTTOM - (this.spec.times ? 14 : 0));
      g.stroke();
      if (this.spec.times && x < this.width - 20) g.fillText(timeText(t, step), x, this.height - 3);
    }
    g.textAlign = "left";
  }
  draw() {
    if (this.element.hidden) return;
    const {g, width, height} = prepared(this.canvas);
    this.width = width;
    this.height = height;
    if (width < LEFT + 20) return;
    if (this.spec.kind === "status") { this.drawStatus(g); return; }
    const all = this.series.map(series => this.columns(series));
    this.findRange(all);
    this.axes(g);
    g.save();
    g.beginPath();
    g.rect(LEFT, TOP - 2, width - LEFT - RIGHT, height - TOP - BOTTOM + 4);
    g.clip();
    this.series.forEach((series, k) => {
      g.fillStyle = series.colour;
      if (series.below) this.band(g, all[k], c => c.low, c => c.high, 0.16);
      if (series.std) this.band(g, all[k], c => c.lo - c.s, c => c.hi + c.s, 0.28);
    });
    this.series.forEach((series, k) => this.line(g, all[k], series));
    if (this.spec.mark) {
      g.strokeStyle = COLOURS.warn;
      g.setLineDash([5, 4]);
      g.beginPath();
      g.moveTo(LEFT, this.y(this.spec.mark));
      g.lineTo(width, this.y(this.spec.mark));
      g.stroke();
    }
    g.restore();
  }
  band(g, columns, low, high, opacity) {
    g.globalAlpha = opacity;
    for (let i = 0; i < columns.length;) {
      if (isNaN(low(columns[i])) || isNaN(high(columns[i]))) { i++; continue; }
      let end = i;
      while (end < columns.length && !isNaN(low(columns[end])) && !isNaN(high(columns[end]))) end++;
      if (columns.dense) {  // bars, as for lines
        for (let k = i; k < end; k++) {
          const top = this.y(high(columns[k]));
          g.fillRect(columns[k].x - 0.5, top, 1, this.y(low(columns[k])) - top);
        }
        i = end;
        continue;
      }
      g.beginPath();
      if (end === i + 1) g.rect(columns[i].x - 1, this.y(high(columns[i])), 2, this.y(low(columns[i])) - this.y(high(columns[i])));
      for (let k = i; k < end && end > i + 1; k++) g.lineTo(columns[k].x, this.y(high(columns[k])));
      for (let k = end - 1; k >= i && end > i + 1; k--) g.lineTo(columns[k].x, this.y(low(columns[k])));
      g.fill();
      i = end;
    }
    g.globalAlpha = 1;
  }
  line(g, columns, series) {
    g.strokeStyle = g.fillStyle = series.colour;
    if (columns.dense) {  // a bar for each pixel, which reaches to the one before: much faster than a path
      let before = null;
      for (const c of columns) {
        if (isNaN(c.lo)) { before = null; continue; }
        let top = this.y(c.hi), bottom = this.y(c.lo);
        if (before) {
          if (before.bottom < top) top = before.bottom;
          if (before.top > bottom) bottom = before.top;
        }
        g.fillRect(c.x - 0.5, top - 0.6, 1, bottom - top + 1.2);
        before = {top: this.y(c.hi), bottom: this.y(c.lo)};
      }
      return;
    }
    g.lineWidth = series.width || 1.5;
    g.lineJoin = "bevel";
    g.setLineDash(series.dash);
    const dots = columns.length < (this.width - LEFT) / 8;
    g.beginPath();
    let open = false;
    columns.forEach((c, k) => {
      if (isNaN(c.lo)) { open = false; return; }
      const middle = (this.y(c.lo) + this.y(c.hi)) / 2;
      if (open) g.lineTo(c.x, middle); else g.moveTo(c.x, middle);
      if (!open && (k + 1 === columns.length || isNaN(columns[k + 1].lo))) g.lineTo(c.x + 1, middle);
      open = true;
    });
    for (const c of columns) {  // entries of several frames
      if (!(c.hi > c.lo)) continue;
      g.moveTo(c.x, this.y(c.lo));
      g.lineTo(c.x, this.y(c.hi));
    }
    g.stroke();
    g.setLineDash([]);
    if (dots) {
      for (const c of columns) {
        if (c.lo !== c.hi) continue;
        g.beginPath();
        g.arc(c.x, this.y(c.lo), 2.2, 0, 7);
        g.fill();
      }
    }
  }
  // A lane for each status, so that colour is not needed to tell them apart.
  drawStatus(g) {
    const logs = this.spec.logs(), lanes = STATUSES.length, top = 4, bottom = this.height - 16;
    const lane = (bottom - top) / lanes, colours = [COLOURS.good, COLOURS.quiet, COLOURS.warn, COLOURS.bad, COLOURS.ink];
    g.font = `10.5px ${COLOURS.font}`;
    g.textAlign = "right";
    STATUSES.forEach((name, s) => {
      g.fillStyle = COLOURS.card;
      g.fillRect(LEFT, top + s * lane + 1, this.width - LEFT - RIGHT, lane - 2);
      g.fillStyle = COLOURS.quiet;
      g.fillText(["ok", "no cont.", "unobs.", "no conv.", "bad"][s], LEFT - 6, top + (s + 0.5) * lane + 4);
    });
    logs.forEach((log, k) => {
      let i = log.indexOf(this.view.t0), run = null;
      if (i > log.first) i--;
      const part = lane / logs.length;
      const paint = (x0, x1, mask) => {
        for (let s = 0; s < lanes; s++) {
          if (!(mask >> s & 1)) continue;
          g.fillStyle = colours[s];
          g.fillRect(x0, top + s * lane + 1 + k * part, Math.max(1, x1 - x0), part - 2);
        }
      };
      for (let x = LEFT; x < this.width - RIGHT; x++) {
        const next = Math.min(log.end, log.indexOf(this.t(x + 1)));
        const mask = next > i ? log.statusMask(i, next) : run && x > run.x && i < log.end ? run.mask : 0;
        if (!run || mask !== run.mask) {
          if (run) paint(run.x, x, run.mask);
          run = {x, mask};
        }
        i = Math.max(i, next);
      }
      if (run) paint(run.x, this.width - RIGHT, run.mask);
    });
    const span = this.view.t1 - this.view.t0, step = niceStep(span, Math.max(2, (this.width - LEFT) / 90));
    g.fillStyle = COLOURS.quiet;
    g.font = `11px ${COLOURS.font}`;
    g.textAlign = "center";
    for (let t = Math.ceil(this.view.t0 / step) * step; t <= this.view.t1; t += step) {
      if (this.x(t) < this.width - 20) g.fillText(timeText(t, step), this.x(t), this.height - 3);
    }
    g.textAlign = "left";
  }
}
