// The data of a log: packed codes, their least and largest values over any range.

async function inflate(base64) {
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = text.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

async function unpackCodes(base64, bits) {
  const bytes = await inflate(base64);
  if (bits === 8) return bytes;
  const n = bytes.length / 2, codes = new Uint16Array(n);
  for (let i = 0, code = 0; i < n; i++) codes[i] = code += bytes[i] << 8 | bytes[n + i];
  return codes;
}

async function unpackWords(base64) {
  const bytes = await inflate(base64), n = bytes.length / 4, words = new Uint32Array(n);
  for (let i = 0, word = 0; i < n; i++) {
    word = word + (bytes[i] << 24 | bytes[n + i] << 16 | bytes[2 * n + i] << 8 | bytes[3 * n + i]) >>> 0;
    words[i] = word;
  }
  return words;
}

// Values of the codes 0 (NaN) to 2^bits - 1.
function valuesOfCodes({bits, log, low, high}) {
  const values = new Float32Array(1 << bits), n = values.length - 2;
  values[0] = NaN;
  for (let code = 1; code <= n + 1; code++) {
    const share = (code - 1) / n;
    values[code] = log ? low * Math.pow(high / low, share) : low + (high - low) * share;
  }
  return values;
}

// A channel of codes with levels of detail: each entry of a level is the least and the
// largest code of 16, 64, 256, ... entries of the channel.
class CodedChannel {
  constructor(description, least, most) {
    this.values = valuesOfCodes(description);
    this.least = least;
    this.most = most;
    this.levels = [];
    let below = {bin: 1, least, most};
    for (let bin = 16; bin < least.length; bin *= 4) {
      const step = bin / below.bin, n = Math.ceil(least.length / bin);
      const level = {bin, least: new least.constructor(n), most: new least.constructor(n)};
      for (let i = 0; i < n; i++) {
        let lo = 0, hi = 0;
        const end = Math.min(below.least.length, (i + 1) * step);
        for (let k = i * step; k < end; k++) {
          const code = below.least[k];
          if (code === 0) continue;
          if (lo === 0 || code < lo) lo = code;
          if (below.most[k] > hi) hi = below.most[k];
        }
        level.least[i] = lo;
        level.most[i] = hi;
      }
      this.levels.push(level);
      below = level;
    }
  }
  // Sets out[0], out[1] to the least and largest value of entries i to end - 1.
  range(i, end, out) {
    let lo = 0, hi = 0, top = this.levels.length - 1;
    while (i < end) {
      let least = this.least, most = this.most, bin = 1;
      for (let l = top; l >= 0; l--) {
        const level = this.levels[l];
        if (i % level.bin === 0 && i + level.bin <= end) { least = level.least; most = level.most; bin = level.bin; break; }
      }
      const k = i / bin, code = least[k];
      if (code !== 0) {
        if (lo === 0 || code < lo) lo = code;
        if (most[k] > hi) hi = most[k];
      }
      i += bin;
    }
    out[0] = this.values[lo];
    out[1] = this.values[hi];
  }
  at(i) { return (this.values[this.least[i]] + this.values[this.most[i]]) / 2; }
}

const STATUSES = ["ok", "no_contact", "unobservable", "not_converged", "bad_input"];

class StaticLog {
  // Entries are frames, or bins of frames_per_bin of them.
  // `table`: shapes under one contact, or none.
  static async unpack(log, table) {
    const self = new StaticLog(), packed = log.packed;
    self.table = table;
    Object.assign(self, {name: log.name, frames: log.frames, hasTime: log.has_time, warnings: log.warnings,
                         framesPerBin: packed.frames_per_bin, first: 0, shift: 0});
    self.status = await unpackCodes(packed.status, 8);
    self.end = self.status.length;
    self.statusLevel = new Uint8Array(Math.ceil(self.end / 64));
    for (let i = 0; i < self.end; i++) self.statusLevel[i >> 6] |= self.status[i];
    self.start = packed.time.start;
    self.step = packed.time.step;
    if (packed.time.words) {
      const words = await unpackWords(packed.time.words), scale = (packed.time.end - self.start) / 4294967295;
      self.times = Float64Array.from(words, w => self.start + scale * w);
    }
    self.channels = {};
    for (const c of packed.channels) {
      const least = await unpackCodes(c.least, c.bits);
      self.channels[c.name] = new CodedChannel(c, least, c.most ? await unpackCodes(c.most, c.bits) : least);
    }
    self.pairs = log.pairs && {frames: log.pairs.frames, moves: await unpackMoves(log.pairs.moves)};
    return self;
  }
  time(i) { return (this.times ? this.times[i] : this.start + this.step * i) + this.shift; }
  // The first entry at or behind a time.
  indexOf(time) {
    time -= this.shift;
    if (!this.times) return Math.max(0, Math.min(this.end, Math.ceil((time - this.start) / this.step - 1e-9)));
    let low = 0, high = this.end;
    while (low < high) {
      const middle = low + high >> 1;
      if (this.times[middle] < time) low = middle + 1; else high = middle;
    }
    return low;
  }
  // The entry nearest to a time.
  nearest(time) {
    const i = Math.min(this.end - 1, this.indexOf(time));
    return i > this.first && time - this.time(i - 1) < this.time(i) - time ? i - 1 : i;
  }
  // Which statuses entries i to end - 1 have: 1 << status.
  statusMask(i, end) {
    let mask = 0;
    while (i < end) {
      const whole = i % 64 === 0 && i + 64 <= end;
      mask |= whole ? this.statusLevel[i >> 6] : this.status[i];
      i += whole ? 64 : 1;
    }
    return mask;
  }
  value(name, i) {
    const channel = this.channels[name];
    return channel && i < this.end ? channel.at(i) : NaN;
  }
  // Tangential over normal force of a contact.
  friction(contact, i) { return this.value(`friction_${contact}`, i) || 0; }
}

// Displacements: [node, x or y] of many shapes behind each other.
async function unpackMoves({low, high, codes}) {
  const values = valuesOfCodes({bits: 16, log: false, low, high});
  return Float32Array.from(await unpackCodes(codes, 16), code => values[code]);
}
async function unpackTable(table) { return {...table, moves: await unpackMoves(table.moves)}; }
