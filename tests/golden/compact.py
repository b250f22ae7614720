#!/usr/bin/env python3
"""Packs the oracle's JSON lines into the tab-separated tables in `data/`.

    python3 tests/golden/compact.py DIRECTORY_OF_JSONL [OUTPUT_DIRECTORY]

The cells are described in README.md. Every value is checked while it is packed: the double
given is the nearest to the 25 digits given, and the logarithm belongs to them.
Standard library only.
"""

import hashlib
import json
import math
import pathlib
import sys
from decimal import Decimal, getcontext
from fractions import Fraction

getcontext().prec = 40
FAMILIES = ["surface", "waves", "fresnel", "series", "bs", "ts", "roughness", "image", "ff", "api"]
SMALLEST_NORMAL = sys.float_info.min


def double(value):
    """Shortest text that reads back as the same double."""
    text = repr(float(value))
    if text.endswith(".0"):
        text = text[:-2]
    mantissa, e, exponent = text.partition("e")
    return mantissa + (f"e{int(exponent)}" if e else "")


def number(value, where):
    """`f~r@l`: nearest double, rest in hundredths of its ulp, log10 where the double cannot tell."""
    f, s, l = value["f"], value["s"], value["l"]
    if l is None:
        assert float(s) == 0 and f == 0, where
        return "0"
    if s is None:
        # Too far below for digits: only the logarithm is known.
        assert f == 0 and l < -1e30, where
        return f"0@{double(l)}"
    # Exponents of thirty digits occur, beyond what Decimal itself takes.
    mantissa, _, exponent = s.partition("e")
    exponent = int(exponent or 0)
    log10 = Decimal(mantissa).copy_abs().log10() + exponent
    assert abs(log10 - Decimal(l)) <= Decimal(4e-16) * (abs(log10) + 1), where
    if isinstance(f, str):
        assert f == "inf" and not s.startswith("-") and log10 > 308, where
        return f"inf@{double(l)}"
    cell = double(f)
    if log10 < -400:
        assert f == 0, where
        return f"{cell}@{double(l)}"
    rest = (Fraction(s) - Fraction(f)) / Fraction(math.ulp(f))
    assert abs(rest) <= Fraction(1, 2) + Fraction(1, 10**6), where
    hundredths = round(rest * 100)
    if f != 0 and hundredths != 0:
        cell += f"~{hundredths}"
    if abs(f) < SMALLEST_NORMAL:
        cell += f"@{double(l)}"
    return cell


def output(value, where):
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    return number(value, where)


def plain(value):
    """An input, or a leaf of a request: JSON, doubles as short as they can be."""
    if isinstance(value, bool) or value is None or isinstance(value, (str, list)):
        return json.dumps(value, separators=(",", ":"))
    return double(value)


def leaves(value, pointer=""):
    """JSON Pointer → leaf; a list is a leaf."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from leaves(inner, f"{pointer}/{key}")
    else:
        yield pointer, value


def row(line):
    where = line["id"]
    cells = {"id": where, "cat": line["cat"]}
    for name, value in line.get("in", {}).items():
        cells[f"in.{name}"] = plain(value)
    for pointer, value in leaves(line.get("request", {})):
        cells[pointer] = plain(value)
    for name, value in line["out"].items():
        cells[f"out.{name}"] = output(value, f"{where} {name}")
    cint = line.get("cint", {})
    for name, value in cint.items():
        cells[f"cint.{name}"] = double(value)
    for name, values in line.get("cond", {}).items():
        # Needed only where there is no cint, and then only the sum.
        if name not in cint and None not in values:
            cells[f"cond.{name}"] = double(f"{sum(float(v) for v in values):.4g}")
    if "cint_excludes_fresnel" in line:
        cells["cint_excludes_fresnel"] = plain(line["cint_excludes_fresnel"])
    return cells


def pack(source, target):
    raw = source.read_bytes()
    rows = [row(json.loads(line)) for line in raw.decode().splitlines()]
    columns = list(dict.fromkeys(name for cells in rows for name in cells))
    text = "\n".join("\t".join(cells.get(name, "") for name in columns) for cells in [dict(zip(columns, columns)), *rows])
    target.write_text(text + "\n")
    return len(rows), hashlib.sha256(raw).hexdigest(), target.stat().st_size


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    source = pathlib.Path(sys.argv[1])
    target = pathlib.Path(sys.argv[2]) if len(sys.argv) == 3 else pathlib.Path(__file__).parent / "data"
    target.mkdir(parents=True, exist_ok=True)
    print("| file | lines | bytes | SHA-256 of the JSON lines |\n| --- | --- | --- | --- |")
    for family in FAMILIES:
        lines, digest, size = pack(source / f"{family}.jsonl", target / f"{family}.tsv")
        print(f"| `{family}.tsv` | {lines} | {size} | `{digest}` |")


main()
