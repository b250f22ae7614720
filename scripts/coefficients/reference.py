"""R(mu, w) = S mu sqrt(w) e^-psi, the lobe series over its leading saddle-point term, in two ways.

`ratio` sums in 80-bit floats, whole arrays at once, good to about 3e-19; `ratio_exact` sums the series as it
stands in 40 digits, one point at a time, and is what `ratio` is checked against.

With s = ln(m/mu) the m-th term relative to the leading one is
    sqrt(w/(2 pi mu)) (mu/m)^(3/2) exp(-[m s - m + mu] - (w - 1)(m - mu)^2/(2 m) - stirling(m)),
which has no cancellation.
"""

import mpmath as mp
import numpy as np

REAL = np.longdouble


def to_real(value):
    """A 40-digit number as an 80-bit float."""
    with mp.workdps(40):
        return REAL(mp.nstr(mp.mpf(value), 25))


with mp.workdps(40):
    PI = to_real(mp.pi)
    _STIRLING_SMALL = np.array(
        [REAL(0)]
        + [
            to_real(mp.loggamma(m + 1) - (m + mp.mpf(1) / 2) * mp.log(m) + m - mp.log(2 * mp.pi) / 2)
            for m in range(1, 32)
        ],
        dtype=REAL,
    )
    _STIRLING_SERIES = [to_real(mp.bernoulli(2 * k) / (2 * k * (2 * k - 1))) for k in range(1, 14)]


def _stirling(m):
    """ln m! - (m + 1/2) ln m + m - ln(2 pi)/2 for whole m >= 1."""
    r = 1 / m
    series = np.zeros_like(m)
    for b in reversed(_STIRLING_SERIES):
        series = series * r * r + b
    small = _STIRLING_SMALL[np.minimum(m, 31).astype(int)]
    return np.where(m < 32, small, series * r)


def _deviance(m, mu):
    """m ln(m/mu) - m + mu."""
    d = m - mu
    v = d / (m + mu)
    tail = np.zeros_like(v)
    for k in range(12, 0, -1):
        tail = tail * v * v + REAL(1) / REAL(2 * k + 1)
    near = d * v + 2 * m * v**3 * tail
    return np.where(np.abs(v) < 0.15, near, m * np.log(m / mu) - d)


def ratio(mu, w, chunk=4000):
    """R at every pair of the arrays mu and w."""
    mu, w = np.asarray(mu, dtype=REAL).ravel(), np.asarray(w, dtype=REAL).ravel()
    result = np.empty_like(mu)
    order = np.argsort(mu / w)
    for start in range(0, len(mu), chunk):
        at = order[start : start + chunk]
        centre, breadth = mu[at][:, None], w[at][:, None]
        deviation = np.sqrt(centre / breadth)
        # Every h-th term is enough only where e^-mu, what the end at m = 0 weighs, is below the rounding.
        sparse = np.maximum(REAL(1), REAL(2) ** np.floor(np.log2(deviation / 3)))
        stride = np.where(centre < 70, REAL(1), sparse)
        first = np.floor(np.maximum(centre - 11 * deviation, 1) / stride)
        last = np.ceil((centre + 13 * deviation + 12) / stride)
        m = (first + np.arange(int((last - first).max()) + 1, dtype=REAL)) * stride
        inside = m >= 1
        m = np.where(inside, m, REAL(1))
        exponent = _deviance(m, centre) + (breadth - 1) * (m - centre) ** 2 / (2 * m) + _stirling(m)
        terms = np.where(inside, np.exp(-exponent) * (centre / m) * np.sqrt(centre / m), 0)
        scale = stride * np.sqrt(breadth / (2 * PI * centre))
        result[at] = (terms.sum(axis=1, keepdims=True) * scale)[:, 0]
    return result


def ratio_exact(mu, w, digits=30):
    """R at one point, from g = mu e^-u and x = mu^2 u, u = (w - 1)/2."""
    with mp.workdps(digits + 25):
        mu, w = mp.mpf(float(mu)), mp.mpf(float(w))
        u = (w - 1) / 2
        g, x = mu * mp.exp(-u), mu * mu * u
        term = lambda m: mp.exp(-g + m * mp.log(g) - mp.loggamma(m + 1) - mp.log(m) - x / m)
        centre = max(int(mp.nint(mu)), 1)
        total = term(centre)
        for step in (1, -1):
            m = centre + step
            while m >= 1:
                t = term(m)
                total += t
                m += step
                if t < total * mp.mpf(10) ** -(digits + 2):
                    break
        psi = g * (mp.expm1(u) - 2 * u * mp.exp(u))
        return total * mu * mp.sqrt(w) * mp.exp(-psi)
