// A log that is still coming: the last entries in rings of fixed size.

const LIVE_ENTRIES = 12000;  // ten minutes at 20 a second; LiveHub keeps as many

class RingChannel {
  constructor(log) {
    this.log = log;
    this.least = new Float32Array(LIVE_ENTRIES).fill(NaN);
    this.most = new Float32Array(LIVE_ENTRIES).fill(NaN);
  }
  range(i, end, out) {
    let lo = NaN, hi = NaN;
    for (; i < end; i++) {
      const k = i % LIVE_ENTRIES;
      if (!(this.least[k] >= lo)) lo = isNaN(this.least[k]) ? lo : this.least[k];
      if (!(this.most[k] <= hi)) hi = isNaN(this.most[k]) ? hi : this.most[k];
    }
    out[0] = lo;
    out[1] = hi;
  }
  at(i) { return this.most[i % LIVE_ENTRIES]; }
}

// Entries are the updates of the server: the least and largest value of the rows since the one before, and the
// last row itself, whose values `at` gives and whose shape is drawn.
class LiveLog {
  constructor({name, channels, nodes}) {
    Object.assign(this, {name, hasTime: true, warnings: [], framesPerBin: 1, first: 0, end: 0, shift: 0, rows: 0, size: 2 * nodes});
    this.times = new Float64Array(LIVE_ENTRIES);
    this.status = new Uint8Array(LIVE_ENTRIES);
    this.masks = new Uint8Array(LIVE_ENTRIES);
    this.numbers = new Float64Array(LIVE_ENTRIES);
    this.frictions = new Float32Array(LIVE_ENTRIES);
    this.last = {};
    this.channels = {};
    for (const channel of channels) {
      this.channels[channel] = new RingChannel(this);
      this.last[channel] = new Float32Array(LIVE_ENTRIES);
    }
    this.names = channels;
    this.shapes = new Float32Array(LIVE_ENTRIES * this.size);
  }
  add(update) {
    const k = this.end % LIVE_ENTRIES;
    this.times[k] = update.time;
    this.status[k] = 1 << update.status;
    this.masks[k] = update.mask;
    this.frictions[k] = update.friction;
    this.numbers[k] = this.rows = update.rows;
    this.names.forEach((name, c) => {
      const number = value => value === null ? NaN : value;
      this.channels[name].least[k] = number(update.least[c]);
      this.channels[name].most[k] = number(update.most[c]);
      this.last[name][k] = number(update.last[c]);
    });
    if (update.shape) this.shapes.set(update.shape, k * this.size);
    else this.shapes.fill(NaN, k * this.size, (k + 1) * this.size);
    this.end++;
    this.first = Math.max(0, this.end - LIVE_ENTRIES);
  }
  slot(i) { return i % LIVE_ENTRIES; }
  time(i) { return this.times[this.slot(i)]; }
  indexOf(time) {
    let low = this.first, high = this.end;
    while (low < high) {
      const middle = low + high >> 1;
      if (this.time(middle) < time) low = middle + 1; else high = middle;
    }
    return low;
  }
  nearest(time) { return StaticLog.prototype.nearest.call(this, time); }
  statusMask(i, end) {
    let mask = 0;
    for (; i < end; i++) mask |= this.masks[this.slot(i)];
    return mask;
  }
  value(name, i) { return this.last[name] ? this.last[name][this.slot(i)] : NaN; }
  friction(contact, i) { return this.frictions[this.slot(i)]; }  // one for all contacts
  shapeAt(i) {
    const k = this.slot(i) * this.size, places = this.shapes.subarray(k, k + this.size);
    return isNaN(places[0]) ? {places: null, words: "No estimate in this frame: undeformed."} : {places, words: ""};
  }
  facts() { return ""; }
  frameText(i) { return `${this.numbers[this.slot(i)]}`; }
  mostForce() { return 0; }  // grows with the updates
}

class Live {
  constructor(page, log) {
    this.page = page;
    this.log = log;
    this.following = this.isNew = true;
    this.span = 30;  // seconds that are shown while it follows
    byId("live").hidden = false;
    byId("compare").hidden = byId("play").hidden = byId("speed").hidden = true;
    this.query = location.search;  // the token
    this.message = this.trouble = "";
    byId("zeroed").href = "finger.yaml" + this.query;
    byId("follow").addEventListener("click", () => this.setFollowing(!this.following));
    byId("zero").addEventListener("click", () => this.zero());
    this.connect();
    this.watch = setInterval(() => { if (performance.now() - this.heardAt > 5000) this.lost(); }, 500);
  }
  setFollowing(on) {
    this.following = on;
    byId("follow").setAttribute("aria-pressed", on);
  }
  state(name, words) {
    byId("connection").className = "chip " + name;
    byId("connection").textContent = words;
  }
  connect() {
    const source = new EventSource("events" + this.query);
    this.heardAt = performance.now();
    source.onopen = () => this.hear();
    source.addEventListener("alive", () => this.hear());
    source.onerror = () => source.readyState === EventSource.CLOSED ? this.refused() : this.lost();
    // What came before the page was opened, or while it was away: all that the server has kept.
    let first = true;
    source.addEventListener("past", event => {
      this.hear();
      if (first) this.log.first = this.log.end = 0;
      first = false;
      const past = JSON.parse(event.data), last = past.pop();
      for (const update of past) this.take(update);
      this.update(last);
    });
    source.onmessage = event => {
      this.hear();
      this.update(JSON.parse(event.data));
    };
    source.addEventListener("end", () => {
      source.close();
      clearInterval(this.watch);
      this.state("no_contact", "the input has ended");
      byId("zero").disabled = true;
    });
  }
  // The server says at least twice a second that it is there.
  hear() {
    this.heardAt = performance.now();
    this.state("good", "live");
    if (!this.trouble) return;
    if (byId("message").textContent === this.trouble) say(this.message);
    this.trouble = "";
  }
  // The figures on the page are no longer true.
  stop(words, why) {
    this.state("bad_input", words);
    this.trouble = why;
    say(why);
    byId("rate").textContent = byId("latency").textContent = "";
    byId("zero").disabled = true;
  }
  lost() {
    if (this.trouble) return;
    const since = new Date(Date.now() - (performance.now() - this.heardAt)).toLocaleTimeString("en-GB");
    this.stop("server lost", `The server has not answered since ${since}: it has ended or cannot be reached. The figures are the last that came. The page goes on if the server comes back.`);
  }
  // An EventSource does not tell why it was refused.
  async refused() {
    const abort = new AbortController();
    setTimeout(() => this.connect(), 3000);
    try {
      const answer = await fetch("events" + this.query, {signal: abort.signal});
      if (!answer.ok) this.stop("refused", (await answer.text()).trim());
    } catch {
      this.lost();
    }
    abort.abort();
  }
  take(update) {
    const {log, page} = this, restarted = log.end > log.first && update.time < log.time(log.end - 1);
    if (restarted) log.first = log.end = 0;
    this.isNew = this.isNew || restarted;
    log.add(update);
    // Frames that are not observable may be far off.
    if (!(update.mask & 4)) page.mostForce = Math.max(page.mostForce, update.most[log.names.indexOf("normal_1_N")] || 0);
  }
  update(update) {
    const {log, page} = this, view = page.view;
    this.take(update);
    view.bounds(log.time(log.first), Math.max(update.time, log.time(log.first) + this.span));
    if (this.isNew) view.show(view.least, this.span);
    this.isNew = false;
    if (this.following) {
      view.cursor = update.time;
      const span = view.t1 - view.t0;
      view.show(Math.max(view.least, update.time - span), span);
    }
    byId("rate").textContent = `${Math.round(update.rate)} rows/s`;
    byId("latency").textContent = `latency ${micros(update.latency[0])}, 99 %: ${micros(update.latency[1])}, most ${micros(update.latency[2])}` +
      (update.missed ? `, ${update.missed} rows not shown` : "");
    if (update.message && update.message !== this.message) say(update.message);
    this.message = update.message;
    byId("zero").disabled = update.zeroing;
    page.redraw();
  }
  async zero() {
    try {
      const answer = await fetch("zero" + this.query, {method: "POST", headers: {"X-Finray": "zero"}});
      say(await answer.text());
    } catch (error) {
      say("The gauges cannot be zeroed: " + error.message + ".");
    }
  }
}

function micros(us) { return us < 1000 ? `${us.toFixed(0)} µs` : `${(us / 1000).toFixed(1)} ms`; }
