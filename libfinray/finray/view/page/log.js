// The page of a log, of two to compare, or of a live one.

const byId = id => document.getElementById(id);

const PLOTS = [
  {title: "Force", unit: "N", height: 170, zero: true, least: 0.1,
   series: (log, k, n) => [
     {name: "normal_1_N", label: n > 1 ? log.name : "contact 1", colour: COLOURS.logs[k], std: "normal_1_std_N", below: "normal_1_N_below", above: "normal_1_N_above"},
     {name: "normal_2_N", label: n > 1 ? "" : "contact 2", colour: n > 1 ? COLOURS.logs[k] : COLOURS.second, dash: [6, 3], std: "normal_2_std_N", below: "normal_2_N_below", above: "normal_2_N_above"},
     {name: "force_N", label: n > 1 ? "" : "force_N, the sensor's", colour: n > 1 ? COLOURS.logs[k] : COLOURS.ink, dash: [2, 3], width: 1.2}]},
  {title: "Place, from the base", unit: "mm", height: 150, least: 2, length: true,
   series: (log, k, n) => [
     {name: "contact_1_mm", label: n > 1 ? log.name : "contact 1", colour: COLOURS.logs[k], std: "contact_1_std_mm", below: "contact_1_mm_below", above: "contact_1_mm_above"},
     {name: "contact_2_mm", label: n > 1 ? "" : "contact 2", colour: n > 1 ? COLOURS.logs[k] : COLOURS.second, dash: [6, 3], std: "contact_2_std_mm", below: "contact_2_mm_below", above: "contact_2_mm_above"}]},
  {title: "Gauge residuals", unit: "std", height: 112, symmetric: true, least: 4,
   series: (log, k, n) => Object.keys(log.channels).filter(name => name.endsWith("_residual_std")).map((name, j) => (
     {name, label: n > 1 ? "" : "gauge " + name.split("_")[1], colour: n > 1 ? COLOURS.logs[k] : COLOURS.gauges[j % COLOURS.gauges.length], width: 1.1}))},
  {title: "p-value of χ²", height: 92, kind: "log", range: () => [1e-12, 1.6], ticks: [1, 0.001, 1e-6, 1e-12], mark: 0.001,
   series: (log, k, n) => [{name: "chi2_p_value", label: n > 1 ? log.name : "", colour: COLOURS.logs[k]}]},
  {title: "Status", height: 96, kind: "status", series: () => []},
];

class Page {
  constructor(data, logs, finger) {
    this.data = data;
    this.logs = logs;
    this.view = new View();
    this.frames = [];  // times of the last redraws in ms
    if (finger) this.picture = new FingerPicture(byId("finger"), finger);
    else byId("finger").closest(".finger").hidden = true;
    readColours();
    const actions = {scrub: t => this.scrub(t), redraw: () => this.redraw(), select: (x0, x1) => this.cursor.select(x0, x1)};
    this.cursor = new Cursor(byId("plots"), this.view);
    this.plots = PLOTS.map(spec => {
      const full = {...spec, logs: () => this.logs};
      if (spec.length && finger) full.range = () => [0, finger.front[finger.front.length - 1]];
      const plot = new Plot(byId("plots"), full, this.view);
      listen(plot, this.view, actions);
      return plot;
    });
    this.connect();
    this.changed();
    this.view.all();
    this.view.cursor = this.view.least;
    this.redraw();
  }
  // After logs have been added or moved.
  changed() {
    const logs = this.logs.filter(log => log.end > log.first);
    if (logs.length) {
      this.view.bounds(Math.min(...logs.map(log => log.time(log.first))), Math.max(...logs.map(log => log.time(log.end - 1))));
    }
    for (const plot of this.plots) plot.setSeries(this.logs);
    this.mostForce = Math.max(1e-3, ...this.logs.map(log => log.mostForce()));
    byId("title").textContent = this.logs.map(log => log.name).join(" and ");
    byId("facts").textContent = this.logs.map(log => log.facts()).join(" · ");
    byId("shift").hidden = this.logs.length < 2;
    byId("warnings").replaceChildren(...this.logs.flatMap(log => log.warnings.map(warning => warningBox(warning, log.name))));
  }
  connect() {
    const view = this.view, on = (id, event, action) => byId(id).addEventListener(event, action);
    on("play", "click", () => this.play(!this.playing));
    on("back", "click", () => this.step(-1));
    on("next", "click", () => this.step(1));
    on("in", "click", () => { view.zoom(0.5, view.cursor); this.redraw(); });
    on("out", "click", () => { view.zoom(2, view.cursor); this.redraw(); });
    on("all", "click", () => { view.all(); this.redraw(); });
    on("scrub", "input", () => this.scrub(view.least + byId("scrub").value * (view.most - view.least)));
    on("other", "change", event => this.compareWith(event.target.files[0]));
    on("seconds", "change", () => { this.logs[1].shift = +byId("seconds").value || 0; this.changed(); this.redraw(); });
    document.addEventListener("keydown", event => {
      if (/INPUT|SELECT|BUTTON|SUMMARY/.test(event.target.tagName) || event.ctrlKey || event.metaKey || event.altKey) return;
      const keys = {ArrowLeft: () => this.step(-1, event.shiftKey), ArrowRight: () => this.step(1, event.shiftKey),
        " ": () => this.play(!this.playing), "+": () => byId("in").click(), "-": () => byId("out").click(),
        "0": () => byId("all").click(), Home: () => this.scrub(view.least), End: () => this.scrub(view.most)};
      if (!keys[event.key]) return;
      event.preventDefault();
      keys[event.key]();
    });
    new ResizeObserver(() => this.redraw()).observe(document.body);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { readColours(); this.changed(); this.redraw(); });
  }
  scrub(t) {
    const view = this.view;
    if (this.live) this.live.setFollowing(false);
    view.cursor = Math.max(view.least, Math.min(view.most, t));
    const before = view.t0;
    view.include(view.cursor);
    this.redraw(view.t0 === before);
  }
  step(direction, far) {
    const log = this.logs[0], i = log.nearest(this.view.cursor);
    if (far) return this.scrub(this.view.cursor + direction * 0.1 * (this.view.t1 - this.view.t0));
    this.scrub(log.time(Math.max(log.first, Math.min(log.end - 1, i + direction))));
  }
  play(on) {
    this.playing = on;
    byId("play").textContent = on ? "⏸" : "▶";
    byId("play").setAttribute("aria-label", on ? "Pause" : "Play");
    if (!on) return;
    if (this.view.cursor >= this.view.most) this.view.cursor = this.view.least;
    let last = performance.now();
    const tick = now => {
      if (!this.playing) return;
      const seconds = (now - last) / 1000 * +byId("speed").value;
      last = now;
      // Without times a frame stands for 1/30 s.
      this.scrub(this.view.cursor + seconds * (this.logs[0].hasTime ? 1 : 30));
      if (this.view.cursor >= this.view.most) return this.play(false);
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }
  // Draws at the next frame of the screen; only what moves with the cursor if the range has stayed.
  redraw(cursorOnly) {
    this.stale = this.stale || !cursorOnly;
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.draw();
    });
  }
  draw() {
    const start = performance.now();
    if (this.stale) for (const plot of this.plots) plot.draw();
    this.stale = false;
    const view = this.view;
    this.cursor.draw(byId("plots").clientWidth);
    if (document.activeElement !== byId("scrub")) byId("scrub").value = (view.cursor - view.least) / (view.most - view.least);
    const entries = this.logs.map(log => log.end > log.first ? log.nearest(view.cursor) : -1);
    if (this.picture) this.drawFinger(entries);
    this.drawReadout(entries);
    this.frames.push(performance.now() - start);
    if (this.frames.length > 600) this.frames.shift();
  }
  drawFinger(entries) {
    const picture = this.picture, finger = picture.finger, words = [];
    picture.begin();
    picture.outline(finger.undeformed, COLOURS.line, 1.5, [4, 4], false);
    entries.forEach((i, k) => {
      if (i < 0) return;
      const log = this.logs[k], shape = finger.shape(log, i);
      if (shape.words) words.push((this.logs.length > 1 ? log.name + ": " : "") + shape.words);
      const places = shape.places || finger.undeformed;
      picture.outline(places, this.logs.length > 1 ? COLOURS.logs[k] : COLOURS.ink, 2.8,
                      shape.places && !shape.approximate ? [] : [7, 5], true);
      if (k === 0) picture.gauges(places);
      if (!shape.places) return;
      const unsure = !(log.status[log.slot ? log.slot(i) : i] & 3), colours = [COLOURS.logs[k], this.logs.length > 1 ? COLOURS.logs[k] : COLOURS.second];
      for (const c of [1, 2]) {
        const value = name => log.value(name, i), arc = value(`contact_${c}_mm`), force = value(`normal_${c}_N`);
        picture.contact(places, {arc, force, low: arc - value(`contact_${c}_mm_below`), high: arc + value(`contact_${c}_mm_above`), friction: log.friction(c, i),
          force_low: force - value(`normal_${c}_N_below`), force_high: force + value(`normal_${c}_N_above`)},
          this.mostForce, unsure ? COLOURS.warn : colours[c - 1], []);
        picture.contact(places, {arc: value(`alternative_contact_${c}_mm`), force: value(`alternative_normal_${c}_N`), friction: log.friction(1, i)},
          this.mostForce, COLOURS.quiet, [3, 3]);
      }
    });
    const text = words.join(" ");
    if (byId("shape").textContent !== text) byId("shape").textContent = text;
  }
  drawReadout(entries) {
    const rows = [["", ...this.logs.map(log => log.name)]], add = (label, cell) => {
      const cells = entries.map((i, k) => i < 0 ? "" : cell(this.logs[k], i));
      if (cells.some(text => text !== "")) rows.push([label, ...cells]);
    };
    const number = (value, places) => isNaN(value) ? "–" : value.toFixed(places).replace(/^-(0\.?0*)$/, "$1").replace("-", "−");
    const spread = (value, std, below, above, places) => isNaN(value) ? "" :
      number(value, places) + (isNaN(std) ? "" : ` ± ${number(std, places)}`) +
      (isNaN(below) ? "" : ` [${number(value - below, places)}, ${number(value + above, places)}]`);
    add("frame", (log, i) => log.frameText(i));
    add("time", (log, i) => log.hasTime ? timeText(log.time(i) - log.shift, 0.001) + " s" : "");
    add("status", (log, i) => STATUSES.filter((_, s) => log.statusMask(i, i + 1) >> s & 1).join(", "));
    for (const c of [1, 2]) {
      add(`force ${c}`, (log, i) => { const v = n => log.value(n, i);
        const text = spread(v(`normal_${c}_N`), v(`normal_${c}_std_N`), v(`normal_${c}_N_below`), v(`normal_${c}_N_above`), 3);
        return text && text + " N"; });
      add(`place ${c}`, (log, i) => { const v = n => log.value(n, i);
        const text = spread(v(`contact_${c}_mm`), v(`contact_${c}_std_mm`), v(`contact_${c}_mm_below`), v(`contact_${c}_mm_above`), 1);
        return text && text + " mm"; });
    }
    add("other solution", (log, i) => { const a = log.value("alternative_contact_1_mm", i), f = log.value("alternative_normal_1_N", i);
      return isNaN(a) ? "" : `${number(a, 1)} mm, ${number(f, 3)} N`; });
    add("force_N", (log, i) => { const f = log.value("force_N", i); return isNaN(f) ? "" : number(f, 3) + " N"; });
    add("residuals", (log, i) => Object.keys(log.channels).filter(n => n.endsWith("_residual_std"))
      .map(n => number(log.value(n, i), 1)).join(", ").replace(/^[–, ]+$/, ""));
    add("p-value", (log, i) => { const p = log.value("chi2_p_value", i); return isNaN(p) ? "" : p < 0.001 ? p.toExponential(0).replace("-", "−") : p.toFixed(3); });
    const table = byId("readout");
    table.classList.toggle("two", this.logs.length > 1);
    while (table.rows.length > rows.length) table.deleteRow(-1);
    rows.forEach((cells, r) => {
      const row = table.rows[r] || table.insertRow();
      while (row.cells.length > cells.length) row.deleteCell(-1);
      cells.forEach((text, c) => {
        const cell = row.cells[c] || row.insertCell();
        if (cell.textContent !== text) cell.textContent = text;
      });
    });
  }
  // Adds the log of another page of finray_view.
  async compareWith(file) {
    if (!file) return;
    try {
      const found = /<script type="application\/json" id="data">(.*?)<\/script>/s.exec(await file.text());
      const data = found && JSON.parse(found[1]);
      if (!data || !data.logs || !data.logs.length) throw new Error("it is not the page of a log");
      const a = this.logs[0];
      const same = this.data.finger && data.finger && JSON.stringify(this.data.finger) === JSON.stringify(data.finger);
      const log = await StaticLog.unpack(data.logs[0], same ? await unpackTable(data.table) : a.table);
      if (log.time(0) > a.time(a.end - 1) || log.time(log.end - 1) < a.time(0)) log.shift = a.time(0) - log.time(0);
      byId("seconds").value = log.shift;
      this.logs = [a, log];
      this.changed();
      this.view.all();
      this.redraw();
      say(this.picture && !same ? `${log.name} is of another finger: its shape is drawn with this one's table.` : "");
    } catch (error) {
      say(`${file.name} cannot be compared: ${error.message}.`);
    }
  }
}

function warningBox(warning, name) {
  const box = document.createElement("div"), code = document.createElement("b");
  box.className = "warning";
  code.textContent = warning.code.replaceAll("_", " ") + ": ";
  box.append(code, `${warning.text}; ${warning.remedy}.`);
  return box;
}

function say(text) {
  byId("message").textContent = text;
  byId("message").hidden = !text;
}

StaticLog.prototype.facts = function () {
  const bins = this.framesPerBin > 1 ? `, least and largest value of each ${this.framesPerBin} frames` : "";
  return `${this.logCount()} frames${bins}`;
};
StaticLog.prototype.logCount = function () { return this.frames.toLocaleString("en").replaceAll(",", "\u202f"); };
StaticLog.prototype.frameText = function (i) {
  const first = i * this.framesPerBin + 1;
  return this.framesPerBin > 1 ? `${first} to ${Math.min(this.frames, first + this.framesPerBin - 1)}` : `${first}`;
};
// The largest force of a frame that is sure, or of any.
StaticLog.prototype.mostForce = function () {
  const most = [0, 0];
  for (const name of ["normal_1_N", "normal_2_N"]) {
    for (let i = 0; this.channels[name] && i < this.end; i++) {
      const force = this.channels[name].at(i), sure = this.status[i] & 4 ? 0 : 1;
      if (force > most[sure]) most[sure] = force;
    }
  }
  return most[1] || most[0];
};

function explain(finger, table) {
  byId("how").textContent = !finger ? "Made without a finger: there is no picture of it and no residual of its gauges."
    : !table ? "Each shape is solved for its frame while it is live. The thick band is the interval of the place, the ticks at the arrow's tail that of the force."
    : `The shape is interpolated between ${[table.arcs, table.forces, table.frictions].map(v => v.length).filter(n => n > 1).join(" by ")} solutions for one contact, to ${table.error_mm.toFixed(3)} mm, up to the largest force of a frame that is ok (beyond it: dashed and named); ` +
      "with two contacts each frame is solved (very long logs: the nearest solved one, dashed and named). The thick band on the beam is the interval of the place, " +
      "the ticks at the arrow's tail that of the force. A dashed grey arrow is a second solution that explains the frame as well.";
}

async function main() {
  const data = JSON.parse(byId("data").textContent);
  const finger = data.finger ? new Finger(data.finger) : null, table = data.table && await unpackTable(data.table);
  explain(finger, table);
  if (data.live) {
    const log = new LiveLog(data);
    const page = new Page(data, [log], finger);
    page.live = new Live(page, log);
    return page;
  }
  const page = new Page(data, await Promise.all(data.logs.map(log => StaticLog.unpack(log, table))), finger);
  const frame = /^#frame=(\d+)$/.exec(location.hash);
  if (frame) {  // a link of the page of all logs
    const log = page.logs[0], i = Math.min(log.end - 1, Math.floor((frame[1] - 1) / log.framesPerBin));
    page.view.show(log.time(i) - 0.05 * (page.view.most - page.view.least), 0.1 * (page.view.most - page.view.least));
    page.scrub(log.time(i));
    page.redraw();
  }
  return page;
}

// For tests and for the curious: await finray.
window.finray = main().catch(error => {
  say(`This page cannot be shown: ${error.message}. It needs a browser of 2023 or later.`);
  throw error;
});
