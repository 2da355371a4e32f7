"""Changes of an input at random: numbers, columns, bytes, lines, words, flags."""

import gzip
import re

NUMBERS = [b"0", b"-1", b"1e-320", b"-1e-9", b"1e9", b"1e15", b"-1e18", b"1e18", b"1e155", b"-1e155", b"1e300", b"1e308",
           b"9.9E+37", b"nan", b"inf", b"-inf", b"1e999", b"", b"0x10", b"1,5", b"2147483648", b"1e-30", b"1e30", b"3.7e12",
           b"99999999999999999999", b".inf", b"-0", b"1000000", b"abc", b"'1'", b"[1, 2]", b"{a: 1}", b"~"]
NUMBER = re.compile(rb"-?\d+\.?\d*(?:[eE][-+]?\d+)?")
PIECES = [b"\0", b"\r", b"\n", b"\n\n", b",", b";", b"\t", b'"', b"'", b"[", b"]", b"{", b"}", b": ", b"&a ", b"*a", b"#",
          b"!!binary ", b"- ", b"\xff", b"\xe9", b"\xef\xbb\xbf", b"| ", b"%", b"\x1b[2J", b"<<: ", b"\x1f\x8b"]


def mutated(data, rng):
    """`data` with one to four changes."""
    for _ in range(rng.choice((1, 1, 1, 2, 2, 3, 4))):
        data = rng.choice(CHANGES)(data, rng)
        if len(data) > 400_000:
            return data[:400_000]
    return data


def other_number(data, rng):
    found = list(NUMBER.finditer(data))
    if not found:
        return data
    at = rng.choice(found)
    value = rng.choice(NUMBERS)
    if rng.random() < 0.6:  # a value of the same kind, of any size or of nearly the same
        value = b"%g" % (float(at[0]) * 10 ** (rng.choice((1, 0.1)) * rng.uniform(-12, 12)) * rng.choice((1, 1, 1, 1, -1)))
    return data[:at.start()] + value + data[at.end():]


def all_numbers_of_a_column(data, rng):
    lines = data.split(b"\n")
    column = rng.randrange(max(1, lines[0].count(b",") + 1))
    value = rng.choice(NUMBERS)
    for i in range(1, len(lines)):
        cells = lines[i].split(b",")
        if column < len(cells):
            cells[column] = value
            lines[i] = b",".join(cells)
    return b"\n".join(lines)


def bytes_flipped(data, rng):
    data = bytearray(data)
    for _ in range(rng.choice((1, 1, 2, 8, 64)) if data else 0):
        data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    return bytes(data)


def piece_inserted(data, rng):
    at = rng.randrange(len(data) + 1)
    return data[:at] + rng.choice(PIECES) * rng.choice((1, 1, 1, 3, 300)) + data[at:]


def cut(data, rng):
    return data[:rng.randrange(len(data) + 1)]


def stretch_removed(data, rng):
    a, b = sorted(rng.randrange(len(data) + 1) for _ in range(2))
    return data[:a] + data[min(b, a + rng.choice((1, 4, 16, 256))):]


def stretch_repeated(data, rng):
    a, b = sorted(rng.randrange(len(data) + 1) for _ in range(2))
    b = min(b, a + rng.choice((4, 64, 512)))
    return data[:b] + data[a:b] * rng.choice((1, 2, 20, 2000)) + data[b:]


def lines_changed(data, rng):
    lines = data.split(b"\n")
    kind = rng.randrange(4)
    i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
    if kind == 0:
        del lines[i]
    elif kind == 1:
        lines.insert(j, lines[i])
    elif kind == 2:
        lines[i], lines[j] = lines[j], lines[i]
    else:
        lines[i:i + 1] = [lines[i]] * rng.choice((3, 50, 3000))
    return b"\n".join(lines)


def words_changed(data, rng):
    words = re.findall(rb"[A-Za-z_]{2,}", data)
    if not words:
        return data
    return data.replace(rng.choice(words), rng.choice((*words, b"", b"contacts", b"ok", b"nan", b"true")),
                        rng.choice((1, -1)))


def packed(data, rng):
    return gzip.compress(data + data[-1:] * rng.choice((0, 0, 5_000_000)), 6)


CHANGES = [other_number] * 6 + [all_numbers_of_a_column] * 3 + [bytes_flipped] * 2 + [
    piece_inserted, cut, stretch_removed, stretch_repeated, lines_changed, lines_changed, words_changed, packed]


def mutated_flag(arguments, rng):
    words = arguments.split()
    numeric = [i for i, word in enumerate(words) if NUMBER.fullmatch(word.encode())]
    if numeric:
        words[rng.choice(numeric)] = rng.choice(NUMBERS).decode("latin-1") or "0"
    else:
        words += rng.choice((["--scheme", "rigid_chain"], ["--scheme", "taylor4"], ["--resolution", "3"],
                             ["--resolution", "400"], ["--seed", "-1"], ["--threads", "3"]))
    return " ".join(words)
