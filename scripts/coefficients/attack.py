#!/usr/bin/env python3
"""Attacks the generated tables as they are committed: the error of every patch at random points of its own seed.

    python3 scripts/coefficients/attack.py [points a patch, 20000 unless said]

Reads the Rust source, so that it shares nothing with the generator but the sum; ends with status 1 if a patch is
off by more than its bound anywhere.
"""

import math
import pathlib
import re
import sys
from types import SimpleNamespace

import numpy as np

from fit import horner
from reference import REAL, ratio

FOLDER = pathlib.Path(__file__).parents[2] / "src/reflectance/numeric/lobe_series/patches"
FIELD = re.compile(r"(\w+): (-?[\d.e+-]+|f64::INFINITY)[,\n]")
ROW = re.compile(r"&\[([^\[\]&]+)\]")


def patches(path):
    for text in path.read_text().split("    Patch {")[1:]:
        fields, rows = text.split("rows: &[", 1)
        values = {k: math.inf if v == "f64::INFINITY" else float(v) for k, v in FIELD.findall(fields)}
        values["rows"] = [[float(a) for a in row.replace("\n", " ").split(",") if a.strip()] for row in ROW.findall(rows)]
        yield SimpleNamespace(**values)


def points(patch, count, random):
    """Evenly in 1/mu or ln mu and in 1/w or ln w, a tenth of them on the edges."""
    most = min(patch.mu_to, 1e7)
    even = 1 / random.uniform(1 / most, 1 / patch.mu_from, count)
    mu = np.where(random.random(count) < 0.5, even, patch.mu_from * (most / patch.mu_from) ** random.random(count))
    mu = np.where(random.random(count) < 0.05, random.choice([patch.mu_from, most], count), mu)
    limit = mu / patch.variance_from if patch.variance_from > 0 else np.inf
    widest = np.maximum(np.minimum(patch.w_to, limit), patch.w_from)
    even = 1 / random.uniform(1 / widest, 1 / patch.w_from)
    w = np.where(random.random(count) < 0.5, even, patch.w_from * (widest / patch.w_from) ** random.random(count))
    w = np.where(random.random(count) < 0.05, np.where(random.random(count) < 0.5, patch.w_from, widest), w)
    return mu, np.clip(w, patch.w_from, widest)


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 20_000
    random = np.random.default_rng(20_250_101)
    attacked, exceeded = 0, False
    for path in sorted(FOLDER.glob("*.rs")):
        worst, doubles = 0.0, 0.0
        for patch in patches(path):
            mu, w = points(patch, count, random)
            results = []
            for real in (REAL, float):
                a, b = mu.astype(real), w.astype(real)
                p = real(patch.p_scale) / a + real(patch.p_shift)
                q = real(patch.q_scale) / (b + real(patch.w_shift)) + real(patch.q_shift)
                results.append(horner(patch.rows, p, q).astype(REAL))
            true = ratio(mu, w)
            error, rounded = (float(np.abs(r / true - 1).max()) for r in results)
            worst, doubles = max(worst, error / patch.error), max(doubles, (rounded - error) / 2.0**-53)
            attacked += count
        if worst > 0:
            exceeded |= worst > 1
            print(f"{path.name:12} worst error {worst:.4f} of its bound, rounding {doubles:.1f} epsilon", flush=True)
    print(f"{attacked} points")
    sys.exit(exceeded)


if __name__ == "__main__":
    main()
