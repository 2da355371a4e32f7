// The finger: its shape at an instant and the picture of it.

class Finger {
  constructor(finger) {
    Object.assign(this, finger);
    this.nodes = finger.front.length + finger.back.length;
  }
  places(moves) { return moves && Float32Array.from(moves, (move, k) => this.undeformed[k] + move); }
  // Displacements under one contact, between the nearest solutions of a table.
  interpolate({arcs, forces, frictions, moves}, arc, force, friction) {
    const size = 2 * this.nodes, out = new Float32Array(size);
    // The two neighbours of x among evenly spaced values, and their weights.
    const neighbours = (values, x) => {
      const last = values.length - 1;
      if (!last) return [[0, 1]];
      const at = (x - values[0]) / (values[last] - values[0]) * last, k = Math.max(0, Math.min(last - 1, Math.floor(at)));
      return [[k, k + 1 - at], [k + 1, at - k]];
    };
    for (const [f, u] of neighbours(forces, force)) {
      for (const [m, v] of neighbours(frictions, friction)) {
        for (const [a, w] of neighbours(arcs, arc)) {
          const weight = u * v * w, start = ((f * frictions.length + m) * arcs.length + a) * size;
          if (weight === 0) continue;
          for (let k = 0; k < size; k++) out[k] += weight * moves[start + k];
        }
      }
    }
    return out;
  }
  // What to draw for entry i: places of nodes, and words where they are not of this very frame.
  shape(log, i) {
    if (log.shapeAt) return log.shapeAt(i);  // live
    const mask = log.status[i], arc = log.value("contact_1_mm", i), force = log.value("normal_1_N", i);
    const none = {places: null, words: "No estimate in this frame: undeformed."};
    if (!(mask & 7)) return none;
    if (log.pairs && !isNaN(log.value("contact_2_mm", i))) return this.pairShape(log, i);
    const free = mask === 2 || isNaN(arc);
    if (free && mask & 4) return none;
    const most = log.table.forces[log.table.forces.length - 1], beyond = !free && force > most * 1.0001;
    const places = this.places(this.interpolate(log.table, free ? 0 : arc, free ? 0 : Math.min(force, most), free ? 0 : log.friction(1, i)));
    if (places.some(isNaN)) return {places: null, words: "The finger has no equilibrium there: undeformed."};
    if (beyond) return {places, approximate: true, words: `No sure frame has so large a force: the shape under ${most.toFixed(2)} N.`};
    return {places, words: log.framesPerBin > 1 ? `The middle of ${log.framesPerBin} frames.` : ""};
  }
  pairShape(log, i) {
    const frame = i * log.framesPerBin, frames = log.pairs.frames, size = 2 * this.nodes;
    if (frames.length === 0) return {places: null, words: "No shape with two contacts was solved: undeformed."};
    let k = frames.findIndex(f => f >= frame);
    if (k < 0) k = frames.length - 1;
    if (k > 0 && frame - frames[k - 1] < frames[k] - frame) k--;
    const off = Math.abs(frames[k] - frame);
    return {places: this.places(log.pairs.moves.subarray(k * size, (k + 1) * size)), approximate: off > 0,
            words: off ? `Two contacts: the shape of frame ${frames[k] + 1}, ${off} away.` : ""};
  }
}

// A place and tangent on the drawn front beam.
function onFront(finger, places, arc) {
  const arcs = finger.front, last = arcs.length - 1;
  let k = arcs.findIndex(a => a >= arc);
  k = Math.max(1, k < 0 ? last : k);
  const share = (arc - arcs[k - 1]) / (arcs[k] - arcs[k - 1]);
  const point = j => [places[2 * j], places[2 * j + 1]];
  const [a, b] = [point(k - 1), point(k)];
  const tangent = j => {
    const [p, q] = [point(Math.max(0, j - 1)), point(Math.min(last, j + 1))];
    return Math.atan2(q[1] - p[1], q[0] - p[0]);
  };
  const theta = (1 - share) * tangent(k - 1) + share * tangent(k);
  return {x: a[0] + share * (b[0] - a[0]), y: a[1] + share * (b[1] - a[1]), theta};
}

class FingerPicture {
  constructor(canvas, finger) {
    this.canvas = canvas;
    this.finger = finger;
    const xs = finger.undeformed.filter((_, k) => k % 2 === 0), ys = finger.undeformed.filter((_, k) => k % 2 === 1);
    this.box = {x0: Math.min(...xs), x1: Math.max(...xs), y1: Math.max(...ys)};
    this.length = finger.front[finger.front.length - 1];
  }
  begin() {
    const {g, width, height} = prepared(this.canvas), size = this.length;
    const x0 = this.box.x0 - 0.36 * size, x1 = this.box.x1 + 0.16 * size, y0 = -0.05 * size, y1 = this.box.y1 + 0.08 * size;
    const scale = Math.min(width / (x1 - x0), height / (y1 - y0));
    this.g = g;
    this.scale = scale;
    this.left = (width - scale * (x1 - x0)) / 2 - scale * x0;
    this.bottom = height + scale * y0 - (height - scale * (y1 - y0)) / 2;
  }
  x(x) { return this.left + this.scale * x; }
  y(y) { return this.bottom - this.scale * y; }
  // A line through nodes, smooth (Catmull-Rom).
  beam(places, from, count) {
    const g = this.g, px = k => this.x(places[2 * (from + Math.max(0, Math.min(count - 1, k)))]);
    const py = k => this.y(places[2 * (from + Math.max(0, Math.min(count - 1, k))) + 1]);
    g.beginPath();
    g.moveTo(px(0), py(0));
    for (let k = 0; k + 1 < count; k++) {
      g.bezierCurveTo(px(k) + (px(k + 1) - px(k - 1)) / 6, py(k) + (py(k + 1) - py(k - 1)) / 6,
                      px(k + 1) - (px(k + 2) - px(k)) / 6, py(k + 1) - (py(k + 2) - py(k)) / 6, px(k + 1), py(k + 1));
    }
    g.stroke();
  }
  outline(places, colour, width, dash, ribs) {
    const {g, finger} = this, front = finger.front.length;
    g.setLineDash(dash);
    if (ribs) {
      g.strokeStyle = COLOURS.quiet;
      g.lineWidth = 1.2;
      for (const [a, b] of finger.ribs) {
        g.beginPath();
        g.moveTo(this.x(places[2 * a]), this.y(places[2 * a + 1]));
        g.lineTo(this.x(places[2 * (front + b)]), this.y(places[2 * (front + b) + 1]));
        g.stroke();
      }
    }
    g.strokeStyle = colour;
    g.lineWidth = width;
    g.lineCap = "round";
    this.beam(places, 0, front);
    this.beam(places, front, finger.back.length);
    g.setLineDash([]);
  }
  gauges(places) {
    const {g, finger} = this;
    g.fillStyle = COLOURS.quiet;
    g.font = `11px ${COLOURS.font}`;
    finger.gauges.forEach((gauge, j) => {
      const arcs = gauge.beam === "front" ? finger.front : finger.back, offset = gauge.beam === "front" ? 0 : finger.front.length;
      const point = arc => {
        let k = Math.max(1, arcs.findIndex(a => a >= arc));
        const u = (arc - arcs[k - 1]) / (arcs[k] - arcs[k - 1]), n = 2 * (offset + k);
        return [places[n - 2] + u * (places[n] - places[n - 2]), places[n - 1] + u * (places[n + 1] - places[n - 1])];
      };
      const [x0, y0] = point(gauge.start), [x1, y1] = point(gauge.end), out = gauge.beam === "front" ? -5 : 5;
      g.strokeStyle = COLOURS.gauges[j % COLOURS.gauges.length];
      g.lineWidth = 3;
      g.beginPath();
      g.moveTo(this.x(x0) + out, this.y(y0));
      g.lineTo(this.x(x1) + out, this.y(y1));
      g.stroke();
      g.fillText(j + 1, this.x((x0 + x1) / 2) + (out < 0 ? -16 : 10), this.y((y0 + y1) / 2) + 4);
    });
  }
  // An arrow along the whole force, into the finger; `contact`: arc, low, high; force, force_low, force_high along the normal; friction.
  contact(places, contact, most, colour, dash) {
    if (isNaN(contact.arc) || isNaN(contact.force)) return;
    const g = this.g, length = force => 0.3 * this.length * Math.min(1, force / most);
    const at = onFront(this.finger, places, contact.arc), sin = Math.sin(at.theta), cos = Math.cos(at.theta);
    const lift = this.finger.surface_mm, mu = contact.friction;
    const head = [at.x - sin * lift, at.y + cos * lift];
    const tail = force => [this.x(head[0] - (sin + mu * cos) * length(force)), this.y(head[1] + (cos - mu * sin) * length(force))];
    if (contact.high > contact.low) {  // the interval of the place, along the beam
      const arcs = this.finger.front, end = arcs[arcs.length - 1];
      g.strokeStyle = colour;
      g.globalAlpha = 0.35;
      g.lineWidth = 11;
      g.lineCap = "butt";
      g.beginPath();
      for (let k = 0; k <= 12; k++) {
        const p = onFront(this.finger, places, Math.max(0, Math.min(end, contact.low + (contact.high - contact.low) * k / 12)));
        g.lineTo(this.x(p.x), this.y(p.y));
      }
      g.stroke();
      g.globalAlpha = 1;
    }
    const [hx, hy] = tail(0), [tx, ty] = tail(contact.force), angle = Math.atan2(hy - ty, hx - tx);
    g.strokeStyle = g.fillStyle = colour;
    g.lineWidth = 2.6;
    g.setLineDash(dash);
    g.beginPath();
    g.moveTo(tx, ty);
    g.lineTo(hx, hy);
    g.stroke();
    g.setLineDash([]);
    g.beginPath();
    g.moveTo(hx, hy);
    for (const side of [-0.42, 0.42]) g.lineTo(hx - 10 * Math.cos(angle + side), hy - 10 * Math.sin(angle + side));
    g.closePath();
    g.fill();
    for (const force of [contact.force_low, contact.force_high]) {  // the interval of the force, at the tail
      if (isNaN(force) || force > most) continue;
      const [x, y] = tail(Math.max(0, force));
      g.lineWidth = 1.4;
      g.beginPath();
      g.moveTo(x - 5 * Math.sin(angle), y + 5 * Math.cos(angle));
      g.lineTo(x + 5 * Math.sin(angle), y - 5 * Math.cos(angle));
      g.stroke();
    }
    g.font = `600 12px ${COLOURS.font}`;
    g.textAlign = "right";
    const text = `${contact.force.toFixed(2)} N`;
    g.fillText(text, Math.max(g.measureText(text).width + 2, tx - 4), Math.max(12, ty - 8));
    g.textAlign = "left";
  }
}
