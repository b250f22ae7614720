"""Coefficients of src/reflectance/numeric/erfc_integral.rs, and reference values for its test and for Smith's functions.

    python3 scripts/coefficients/erfc_integral.py

ierfc(v) = integral of erfc from v on = e^{-v^2} K(v), K(v) = 1/sqrt(pi) - v e^{v^2} erfc(v). K is smooth in
u = (ALPHA v - A)/(v + A), which takes 0 <= v <= LAST to [-1, 1]; its Chebyshev series, cut where what is left out is
below 1e-18, is written as a polynomial in u. The magnitudes of its coefficients add up to K(0), so that nothing cancels.
"""

import mpmath as mp

mp.mp.dps = 60
A, LAST = mp.mpf(4), mp.mpf(6)
ALPHA = (LAST + 2 * A) / LAST
DEGREE = 19


def scaled(v):
    """K(v)."""
    return 1 / mp.sqrt(mp.pi) - v * mp.exp(v * v) * mp.erfc(v)


def ierfc(v):
    """The integral of erfc from v on."""
    return mp.exp(-v * v) * scaled(v)


def chebyshev(f, count):
    """The coefficients of f on [-1, 1] by interpolation in `count` points."""
    angles = [mp.pi * (j + mp.mpf(1) / 2) / count for j in range(count)]
    values = [f(mp.cos(angle)) for angle in angles]
    return [
        (2 if k else 1) * sum(value * mp.cos(k * angle) for value, angle in zip(values, angles)) / count
        for k in range(count)
    ]


def monomials(series):
    """A Chebyshev series by powers."""
    total = [mp.mpf(0)] * len(series)
    before, power = [mp.mpf(1)], [mp.mpf(0), mp.mpf(1)]
    for coefficient in series:
        for i, term in enumerate(before):
            total[i] += coefficient * term
        following = [mp.mpf(0)] + [2 * term for term in power]
        for i, term in enumerate(before):
            following[i] -= term
        before, power = power, following
    return total


def smith(degrees, width):
    """1 + Lambda as the projections of the facets turned to the viewer, over the mean plane's: the definition."""
    if degrees == 0:
        return mp.mpf(1)
    theta = mp.mpf(degrees) * mp.pi / 180
    sin, cos, width = mp.sin(theta), mp.cos(theta), mp.mpf(width)
    edge = -cos / sin / width
    density = lambda t: (cos + sin * width * t) * mp.exp(-t * t) / mp.sqrt(mp.pi)
    pieces = [edge] + [t for t in range(-12, 12) if t > edge] + [max(mp.mpf(12), edge + 12)]
    return mp.quad(density, pieces) / cos


def main():
    series = chebyshev(lambda u: scaled(A * (1 + u) / (ALPHA - u)), 60)
    left_out = sum(abs(c) for c in series[DEGREE + 1 :])
    print(f"alpha {mp.nstr(ALPHA, 20)}, left out {mp.nstr(left_out, 3)}, beyond {LAST}: {mp.nstr(ierfc(LAST) / LAST, 3)}")
    for coefficient in monomials(series[: DEGREE + 1]):
        print(f"    {float(coefficient)!r},")
    print("ierfc")
    for v in [0, 0.001, 0.1, 0.3, 0.5, 0.8, 1.3, 2, 3.1, 4.5, 5.9]:
        print(f"    ({v!r}, {float(ierfc(mp.mpf(v)))!r}),")
    print("1 + Lambda by the definition: m, and the values at these zeniths")
    zeniths = [0, 20, 60, 85, 89.9]
    for width in [0.05, 0.4, 3]:
        print(f"    ({width}, {[float(smith(degrees, width)) for degrees in zeniths]!r}),")


if __name__ == "__main__":
    main()
