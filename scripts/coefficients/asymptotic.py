#!/usr/bin/env python3
"""Exact coefficients of the expansion of R = S mu sqrt(w) e^-psi in 1/mu, and how large what follows is.

    python3 scripts/coefficients/asymptotic.py

Laplace's method: with m = mu e^s and Stirling's series the sum's integral is
    R = sqrt(mu w/(2 pi)) int exp(-mu f(s) - s/2 - sum_k b_k e^{-(2k-1)s}/mu^(2k-1)) ds,
    f(s) = e^s (s - 1) + 1 + (w - 1)(cosh s - 1) = w s^2/2 + s^3/3 + ...,   b_k = B_2k/(2k (2k - 1)).
With s = y/sqrt(mu w) the integrand is a Gaussian times a series in 1/sqrt(mu), and the moments of the Gaussian
are whole numbers, so everything is exact. c_k is a polynomial of degree 3k in t = 1/w.
"""

import math
import sys
from fractions import Fraction

import mpmath as mp
import numpy as np

from reference import REAL, ratio

# c_1 ... c_4 as first derived by hand, times their denominators, lowest power of t first.
KNOWN = {
    1: (12, [-1, 0, 3, 10]),
    2: (288, [1, -24, -30, -92, -399, -420, 1540]),
    3: (51840, [139, 540, 405, -930, 12825, 129816, 278355, -810810, -2702700, 3403400]),
}


def product(a, b):
    """Of two polynomials in y and sqrt(t): {(power of y, power of sqrt(t)): coefficient}."""
    result = {}
    for (i, j), p in a.items():
        for (k, l), q in b.items():
            result[i + k, j + l] = result.get((i + k, j + l), 0) + p * q
    return result


def exponents(last):
    """The exponent but for -y^2/2, by powers of h = 1/sqrt(mu)."""
    terms = [{} for _ in range(last + 1)]

    def add(h, y, root, value):
        if h <= last:
            terms[h][y, root] = terms[h].get((y, root), 0) + value

    add(1, 1, 1, Fraction(-1, 2))
    for n in range(3, last + 3):
        factorial = math.factorial(n)
        # f_n = (n - 1)/n! for odd n, (n - 2 + w)/n! for even n; w t = 1.
        add(n - 2, n, n, Fraction(-(n - 1 if n % 2 else n - 2), factorial))
        if n % 2 == 0:
            add(n - 2, n, n - 2, Fraction(-1, factorial))
    for k in range(1, last // 4 + 2):
        power = 2 * k - 1
        p, q = mp.bernfrac(2 * k)
        b = Fraction(int(p), int(q)) / (2 * k * power)
        for n in range(last + 1):
            add(2 * power + n, n, n, -b * Fraction((-power) ** n, math.factorial(n)))
    return terms


def coefficients(order):
    """c_0 ... c_order as lists of Fractions, lowest power of t first."""
    last = 2 * order
    a = exponents(last)
    series = [{(0, 0): Fraction(1)}]
    for n in range(1, last + 1):
        total = {}
        for k in range(1, n + 1):
            for power, value in product(a[k], series[n - k]).items():
                total[power] = total.get(power, 0) + value * Fraction(k, n)
        series.append(total)
    result = []
    for k in range(order + 1):
        polynomial = [Fraction(0)] * (3 * k + 1)
        for (y, root), value in series[2 * k].items():
            # The mean of y^(2m) is (2m - 1)!!.
            if y % 2 == 0:
                polynomial[root // 2] += value * math.prod(range(1, y, 2))
        result.append(polynomial)
    return result


def whole(polynomial):
    denominator = math.lcm(*(c.denominator for c in polynomial))
    return denominator, [int(c * denominator) for c in polynomial]


def evaluate(polynomial, t):
    total = np.zeros_like(t)
    for c in reversed(polynomial):
        total = total * t + REAL(mp.nstr(mp.mpf(c.numerator) / c.denominator, 25))
    return total


def main():
    order = int(sys.argv[1]) if len(sys.argv) > 1 else 9
    mp.mp.dps = 40
    c = coefficients(order)
    for k, expected in KNOWN.items():
        assert whole(c[k]) == expected, k
    # At x = 0, where t = 1, R = 1 + 1/g + 2/g^2 + 6/g^3 + ...
    assert all(sum(c[k]) == math.factorial(k) for k in range(order + 1))
    for k in range(1, order + 1):
        denominator, numerators = whole(c[k])
        print(f"c_{k} = {numerators} / {denominator}")
    remainders(c)


def remainders(c):
    """How the error of order k compares with the next coefficient, over mu >= 16 and variances >= 2.5."""
    order = len(c) - 1
    t = np.linspace(0.004, 1, 1500, dtype=REAL)
    # The largest |c_k| up to t: it has no zeros as c_k has.
    envelope = [np.maximum.accumulate(np.abs(evaluate(p, t)).astype(float)) for p in c]
    print("\nmax |c_k| over 0 <= t <= 1:", *(f"{k}: {e[-1]:.6g}" for k, e in enumerate(envelope)))
    worst = np.zeros((order, len(t)))
    print("\nworst |R - order k| mu^(k+1) over max of |c_(k+1)| up to t, k = 0, 1, ...")
    for mu in np.geomspace(16, 4096, 65):
        inside = t * mu >= 2.5
        true = ratio(np.full(inside.sum(), mu, dtype=REAL), 1 / t[inside])
        partial, row = np.zeros_like(true), []
        for k in range(order):
            partial = partial + evaluate(c[k], t[inside]) / REAL(mu) ** k
            error = np.abs(partial - true)
            # Below it is what the sum in 80 bits rounds.
            size = np.where(error > 3e-18, error * REAL(mu) ** (k + 1), 0).astype(float)
            worst[k][inside] = np.maximum(worst[k][inside], size)
            row.append((size / envelope[k + 1][inside]).max())
        if abs(math.log2(mu) - round(math.log2(mu))) < 1e-9:
            print(f"mu {mu:5.0f}: " + " ".join(f"{value:8.4g}" for value in row))
    print("over all:  " + " ".join(f"{(worst[k] / envelope[k + 1]).max():8.4g}" for k in range(order)))
    print("\nmax of |c_k| up to t over k!, k = 1, 2, ...")
    for at in (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95, 1):
        place = min(np.searchsorted(t, at), len(t) - 1)
        print(f"t {at:4.2f}: " + " ".join(f"{e[place] / math.factorial(k):9.3g}" for k, e in enumerate(envelope) if k))


if __name__ == "__main__":
    main()
