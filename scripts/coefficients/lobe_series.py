#!/usr/bin/env python3
"""Makes src/reflectance/numeric/lobe_series/patches/*.rs, but for mod.rs: polynomials for R(1/mu, 1/w).

    python3 scripts/coefficients/lobe_series.py            # every tier: about a quarter of an hour on two cores
    python3 scripts/coefficients/lobe_series.py full e9    # these alone

Needs numpy with 80-bit long doubles (x86-64 Linux) and mpmath; uses no random numbers but seeded ones. The same
versions give the same files; other versions of LAPACK may move last digits and, rarely, a length.

Every error that it writes is of the printed doubles, against the sum in 80-bit floats on 60,000 points with edges
and corners, and of twenty of them against the sum in 40 digits.
"""

import math
import os
import pathlib
import sys
from decimal import Decimal

os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np  # noqa: E402

from fit import Fit, Region, horner, lengths  # noqa: E402
from reference import REAL, ratio, ratio_exact, to_real  # noqa: E402

FOLDER = pathlib.Path(__file__).parents[2] / "src/reflectance/numeric/lobe_series/patches"
EPSILON = 2.0**-53
INF = math.inf
# Poles that were tried: the nearer to w = 1, the better for the end at m = 0, the worse for large w.
SHIFTS = (0.0, -0.25, -0.5, -0.625, -0.75, -0.8125, -0.875)

# tier: (largest error, [(mu_from, mu_to, variance_from, where w is divided)]).
# A divided band is fitted up to the division and beyond it; with beyond = None only up to it.
TIERS = {
    "full": (4 * EPSILON, [
        (8, 10, None, 1.5), (10, 12, None, 1.5), (12, 14, 4, 1.5), (14, 16, 4, 1.5), (16, 20, 4, 1.5),
        (20, 24, 4, 1.5), (24, 32, 3, 1.5), (32, 40, 2.5, 1.5), (40, 64, 2.3, 1.5), (64, 128, 2.1, INF),
        (128, 512, 2.05, INF), (512, 4096, 2, INF), (4096, INF, 2, INF),
    ]),
    "e12": (2.5e-13, [
        (6, 8, None, 1.5), (8, 10, 3, 1.5), (10, 12, 3, 1.5), (12, 14, 3, 1.5), (14, 16, 3, 1.5), (16, 20, 3, 1.5),
        (20, 28, 2.3, 1.5), (28, 40, 1.85, 1.5), (40, 64, 1.75, 1.5), (64, 128, 1.7, INF), (128, 512, 1.6, INF),
        (512, 4096, 1.6, INF), (4096, INF, 1.6, INF),
    ]),
    "e9": (2.5e-10, [
        (2, 3, None, 2), (3, 4, None, 2), (4, 5, 2, 1.5), (5, 6, 2, 1.5), (6, 8, 2, 1.5), (8, 10, 2, 1.5),
        (10, 12, 2, 1.5), (12, 16, 2, 1.5), (16, 24, 1.75, 1.5), (24, 40, 1.4, 1.5), (40, 64, 1.4, INF), (64, 256, 1.3, INF),
        (256, 2048, 1.25, INF), (2048, INF, 1.22, INF),
    ]),
    "e6": (2.5e-7, [
        (1, 2, None, 1.5), (2, 3, None, 2), (3, 4, None, 2), (4, 6, 1.5, 1.5), (6, 8, 1.5, 1.5), (8, 12, 1.5, 1.5),
        (12, 24, 1.2, 1.5), (24, 64, 0.97, INF), (64, 512, 0.95, INF), (512, INF, 0.94, INF),
    ]),
    "e3": (2.5e-4, [
        (1, 2, None, 1.5), (2, 3, 1, 1.5), (3, 4, 1, 1.5), (4, 6, 0.8, 1.5), (6, 8, 0.75, 1.5), (8, 12, 0.66, INF),
        (12, 24, 0.6, INF), (24, 128, 0.57, INF), (128, INF, 0.55, INF),
    ]),
    "e1": (2.5e-2, [
        (1, 2, 0.5, INF), (2, 4, 0.5, INF), (4, 16, 0.4, INF), (16, INF, 0.3, INF),
    ]),
}
SUMMARY = {"full": "4 ε, ε = 2⁻⁵³", "e12": "2.5e-13", "e9": "2.5e-10", "e6": "2.5e-7", "e3": "2.5e-4", "e1": "2.5e-2"}


def rounded(value, target):
    """The double nearest to the value at as many decimals as the target needs."""
    quantum = Decimal(1).scaleb(math.floor(math.log10(target / 100)))
    return float(Decimal(np.format_float_scientific(value, unique=True)).quantize(quantum))


def check_points(region, seed):
    random = np.random.default_rng(seed)
    mu1, w1 = region.grid(150, 260)
    a = random.uniform(-1, 1, 21_000)
    b = random.uniform(-1, 1, 21_000)
    # Edges and corners once more, on the doubles next to them.
    a[:500], b[:500] = -1, random.uniform(-1, 1, 500)
    a[500:1000], b[500:1000] = 1, random.uniform(-1, 1, 500)
    b[1000:1500], b[1500:2000] = -1, 1
    mu2, w2 = region.place(a.astype(REAL), b.astype(REAL))
    mu, w = np.concatenate([mu1, mu2]).astype(float), np.concatenate([w1, w2]).astype(float)
    mu = np.clip(mu, region.mu_from, min(region.mu_to, 1e300))
    return mu, np.maximum(w, region.w_from)


def measured(region, rows, seed):
    """The largest relative error of the polynomial as it stands, and as doubles evaluate it."""
    mu, w = check_points(region, seed)
    wide_mu, wide_w = mu.astype(REAL), w.astype(REAL)
    true = ratio(wide_mu, wide_w)
    polynomial = horner(rows, *region.variables(wide_mu, wide_w))
    doubles = horner(rows, *region.variables(mu, w))
    truncation = np.abs(polynomial / true - 1)
    for at in np.random.default_rng(seed + 1).integers(0, len(mu), 20):
        if w[at] < 1e3:
            exact = to_real(ratio_exact(mu[at], w[at]))
            assert abs(true[at] / exact - 1) < 1e-18, (mu[at], w[at])
    return float(truncation.max()), float(np.abs(doubles.astype(REAL) / true - 1).max())


def make(job):
    tier, target, mu_from, mu_to, w_from, w_to, variance_from = job
    # At the finest, half is for the rounding of the coefficients.
    aim = 0.5 * target if tier == "full" else 0.97 * target
    best = None
    for shift in SHIFTS:
        fit = Fit(Region(mu_from, mu_to, w_from, w_to, variance_from, shift))
        try:
            length = fit.thin(aim)
        except ValueError:
            continue
        if best is None or length < best[0]:
            best = (length, fit)
    fit = best[1]
    while True:
        table = fit.coefficients(aim)
        rows = [[rounded(a, target) for a in row[:n]] for row, n in zip(table, lengths(table))]
        error, evaluated = measured(fit.region, rows, seed=round(1000 * mu_from) + round(10 * w_from))
        if 1.01 * error <= target:
            return tier, fit.region, rows, error, evaluated
        aim *= 0.97


def round_up(value):
    """With a hundredth more for what lies between the points measured, to three digits."""
    step = 10.0 ** (math.floor(math.log10(value)) - 2)
    return float(f"{math.ceil(1.01 * value / step) * step:.2e}")


def number(value):
    return "f64::INFINITY" if math.isinf(value) else repr(float(value))


def patch_source(region, rows, error, evaluated):
    mu_to = "∞" if math.isinf(region.mu_to) else f"{region.mu_to:g}"
    count = sum(map(len, rows))
    lines = [
        f"    // μ from {region.mu_from:g} to {mu_to}, w from {region.w_from:g}: {count} coefficients; as doubles "
        f"evaluate it: {evaluated:.1e}.",
        "    Patch {",
        f"        mu_from: {number(region.mu_from)}, mu_to: {number(region.mu_to)}, w_from: {number(region.w_from)}, "
        f"w_to: {number(region.w_to)}, variance_from: {number(region.variance_from)},",
        f"        p_scale: {number(region.p_scale)}, p_shift: {number(region.p_shift)},",
        f"        w_shift: {number(region.w_shift)}, q_scale: {number(region.q_scale)}, q_shift: {number(region.q_shift)},",
        f"        error: {round_up(error)!r},",
        "        rows: &[",
    ]
    for row in rows:
        text, line = [], "            &["
        for value in row:
            piece = f"{number(value)}, "
            if len(line) + len(piece) > 112:
                text.append(line.rstrip())
                line = "                " + piece
            else:
                line += piece
        text.append(line.removesuffix(", ") + "],")
        lines += text
    return "\n".join([*lines, "        ],", "    },"]) + "\n"


def write(tier, patches):
    """One file a tier, or several of fewer than 400 lines."""
    target = TIERS[tier][0]
    texts = [patch_source(*patch) for patch in patches]
    parts, size = [[]], 0
    for text in texts:
        length = text.count("\n")
        if size + length > 370:
            parts.append([])
            size = 0
        parts[-1].append(text)
        size += length
    for old in FOLDER.glob(f"{tier}*.rs"):
        old.unlink()
    total = sum(len(row) for patch in patches for row in patch[1])
    for at, part in enumerate(parts):
        name = tier if len(parts) == 1 else f"{tier}_{at + 1}"
        head = (
            f"//! R to {SUMMARY[tier]}: {len(patches)} patches of {total} coefficients"
            + (f", part {at + 1} of {len(parts)}" if len(parts) > 1 else "")
            + f".\n//! Generated by `python3 scripts/coefficients/lobe_series.py {tier}`, which measured the errors.\n\n"
            "use super::Patch;\n\n#[rustfmt::skip]\npub(super) const PATCHES: &[Patch] = &[\n"
        )
        (FOLDER / f"{name}.rs").write_text(head + "".join(part) + "];\n")
    print(f"{tier}: {len(patches)} patches, {total} coefficients, {len(parts)} files, aim {target:g}")


def main():
    from multiprocessing import Pool

    jobs = []
    for tier in sys.argv[1:] or TIERS:
        target, bands = TIERS[tier]
        for mu_from, mu_to, variance_from, divided in bands:
            jobs.append((tier, target, mu_from, mu_to, 1.0, divided, 0.0 if divided < INF else variance_from))
            if divided < INF and variance_from is not None:
                jobs.append((tier, target, mu_from, mu_to, divided, INF, variance_from))
    made = {}
    with Pool(2) as pool:
        for tier, region, rows, error, evaluated in pool.imap(make, jobs):
            made.setdefault(tier, []).append((region, rows, error, evaluated))
            print(f"{tier} mu {region.mu_from:g}..{region.mu_to:g} w {region.w_from:g}..{region.w_to:g} "
                  f"V>={region.variance_from:g} shift {region.w_shift:g}: {sum(map(len, rows))} "
                  f"{[len(row) for row in rows]} error {error:.3g}, doubles {evaluated:.3g}", flush=True)
    FOLDER.mkdir(parents=True, exist_ok=True)
    for tier, patches in made.items():
        write(tier, patches)


if __name__ == "__main__":
    main()
