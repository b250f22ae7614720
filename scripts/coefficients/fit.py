"""Polynomials in two variables with few coefficients and a small largest relative error.

A region is mu in [mu_from, mu_to], w in [w_from, w_to], mu/w >= variance_from. Its variables are
p = p_scale/mu + p_shift and q = q_scale/(w + w_shift) + q_shift, both in [-1, 1].
"""

import numpy as np

from reference import REAL, ratio


def _clustered(count):
    """Chebyshev's extrema, which crowd towards the ends of [-1, 1]."""
    return -np.cos(REAL(np.pi) * np.arange(count, dtype=REAL) / REAL(count - 1))


class Region:
    """Where a polynomial is wanted, and the map to [-1, 1]^2 in constants that are doubles."""

    def __init__(self, mu_from, mu_to, w_from, w_to, variance_from, w_shift):
        self.mu_from, self.mu_to = mu_from, mu_to
        self.w_from, self.w_to = w_from, w_to
        self.variance_from, self.w_shift = variance_from, w_shift
        low, high = 1 / mu_to, 1 / mu_from
        self.p_scale = 2 / (high - low)
        self.p_shift = -(high + low) / (high - low)
        widest = min(w_to, mu_to / variance_from if variance_from > 0 else np.inf)
        low, high = 1 / (widest + w_shift), 1 / (w_from + w_shift)
        self.q_scale = 2 / (high - low)
        self.q_shift = -(high + low) / (high - low)

    def variables(self, mu, w):
        """p and q in the precision of mu and w."""
        one = mu.dtype.type(1)
        real = mu.dtype.type
        p = real(self.p_scale) * (one / mu) + real(self.p_shift)
        q = real(self.q_scale) * (one / (w + real(self.w_shift))) + real(self.q_shift)
        return p, q

    def place(self, a, b):
        """The points of the region for a and b in [-1, 1]: a along 1/mu, b along 1/(w + w_shift)."""
        r = (REAL(a) - REAL(self.p_shift)) / REAL(self.p_scale)
        mu = 1 / np.maximum(r, REAL(1e-4) / REAL(self.mu_from))
        mu = np.clip(mu, REAL(self.mu_from), REAL(self.mu_to))
        widest = np.minimum(REAL(self.w_to), mu / REAL(self.variance_from) if self.variance_from else np.inf)
        widest = np.clip(widest, REAL(self.w_from), REAL(1e6))
        low, high = 1 / (widest + REAL(self.w_shift)), 1 / (REAL(self.w_from) + REAL(self.w_shift))
        w = 1 / ((low + high) / 2 + (high - low) / 2 * b) - REAL(self.w_shift)
        return mu, np.clip(w, REAL(self.w_from), widest)

    def grid(self, along_p, along_q):
        a, b = np.meshgrid(_clustered(along_p), _clustered(along_q), indexing="ij")
        return self.place(a.ravel(), b.ravel())


def _chebyshev(count, x):
    values = [np.ones_like(x), x]
    while len(values) < count:
        values.append(2 * x * values[-1] - values[-2])
    return values[:count]


class Fit:
    """Least squares for R in T_j(p) T_i(q), i < rows[j], relative to R."""

    POINTS = (36, 80)

    def __init__(self, region):
        self.region = region
        mu, w = region.grid(*self.POINTS)
        self.value = ratio(mu, w)
        self.p, self.q = region.variables(mu, w)

    def _matrix(self, index):
        across, along = 1 + max(j for j, _ in index), 1 + max(i for _, i in index)
        tp, tq = _chebyshev(max(across, 2), self.p), _chebyshev(max(along, 2), self.q)
        return np.stack([tp[j] * tq[i] / self.value for j, i in index], axis=1)

    def _solve(self, matrix, weight, refinements):
        """Weighted least squares for 1, refined to the precision of REAL, and the residuals."""
        root = np.sqrt(weight)
        orthogonal, triangle = np.linalg.qr(matrix.astype(float) * root[:, None])
        coefficients = np.zeros(matrix.shape[1], dtype=REAL)
        residual = np.ones(matrix.shape[0], dtype=REAL)
        for _ in range(1 + refinements):
            right = orthogonal.T @ (residual.astype(float) * root)
            coefficients = coefficients + np.linalg.solve(triangle, right)
            residual = 1 - matrix @ coefficients
        return coefficients, residual, triangle

    def _thinned(self, limit, across, along):
        """Takes off, one by one, the last coefficient of a row that matters least, while the largest error
        stays below the limit: the errors and rows on the way. None if the start is not good enough."""
        index = [(j, i) for j in range(across) for i in range(along) if j / across + i / along <= 1 + 1e-9]
        matrix = self._matrix(index)
        coefficients, residual, triangle = self._solve(matrix, np.ones(matrix.shape[0]), 3)
        start = np.abs(residual).max()
        if start > 0.15 * limit:
            return None
        matrix, residual, c = matrix.astype(float), residual.astype(float), coefficients.astype(float)
        inverse = np.linalg.inv(triangle)
        covariance = inverse @ inverse.T
        column = {pair: at for at, pair in enumerate(index)}
        rows = [sum(1 for j, _ in index if j == row) for row in range(across)]
        way = [(float(start), list(rows))]
        while True:
            last = [(row, column[row, length - 1]) for row, length in enumerate(rows) if length > 0]
            last.sort(key=lambda entry: c[entry[1]] ** 2 / covariance[entry[1], entry[1]])
            for row, k in last[:3]:
                change = -covariance[:, k] * (c[k] / covariance[k, k])
                without = residual - matrix @ change
                if np.abs(without).max() <= limit:
                    break
            else:
                return way
            c, residual = c + change, without
            c[k] = 0
            rows[row] -= 1
            covariance -= np.outer(covariance[:, k], covariance[:, k]) / covariance[k, k]
            covariance[k, :] = covariance[:, k] = 0
            way.append((float(np.abs(residual).max()), [n for n in rows if n > 0]))

    def _levelled(self, rows, target):
        """Lawson's iteration: weights grow where the error is large, which lowers the largest."""
        index = [(j, i) for j, length in enumerate(rows) for i in range(length)]
        matrix = self._matrix(index)
        weight = np.ones(matrix.shape[0])
        for _ in range(16):
            coefficients, residual, _ = self._solve(matrix, weight, 2)
            size = np.abs(residual).astype(float)
            if size.max() <= target:
                return dict(zip(index, coefficients))
            weight = weight * (size / size.max() + 0.02)
            weight /= weight.mean()
        return None

    def thin(self, target):
        """Finds rows for the target; how many coefficients they have."""
        for across, along in ((6, 14), (8, 20), (11, 28), (14, 36), (18, 44), (22, 50)):
            self.way = self._thinned(2 * target, across, along)
            if self.way:
                return sum(self._rows_within(1.5 * target))
        raise ValueError(f"no polynomial reaches {target}")

    def _rows_within(self, limit):
        return min((rows for error, rows in self.way if error <= limit), key=sum)

    def coefficients(self, target):
        """Rows in powers of p and q, as REAL, with an error of at most target on the points."""
        for looser in (2.0, 1.8, 1.6, 1.45, 1.3, 1.15, 1.0, 0.8):
            rows = self._rows_within(target * looser)
            found = self._levelled(rows, target)
            if found:
                return _powers(found, rows)
        raise ValueError(f"no polynomial reaches {target}")


def _powers(found, rows):
    """From products of Chebyshev polynomials to powers."""
    across, along = len(rows), max(rows)
    size = max(across, along)
    chebyshev = np.zeros((max(size, 2), max(size, 2)), dtype=REAL)
    chebyshev[0, 0] = chebyshev[1, 1] = 1
    for n in range(2, size):
        chebyshev[n, 1:] = 2 * chebyshev[n - 1, :-1]
        chebyshev[n] -= chebyshev[n - 2]
    table = np.zeros((across, along), dtype=REAL)
    for (j, i), value in found.items():
        table += value * np.outer(chebyshev[j, :across], chebyshev[i, :along])
    return table


def lengths(table):
    return [int(np.flatnonzero(row).max()) + 1 if np.any(row) else 0 for row in table]


def horner(rows, p, q):
    """What the service computes, in the precision of p and q."""
    real = p.dtype.type
    total = np.zeros_like(p)
    for row in reversed(rows):
        inner = np.zeros_like(q)
        for a in reversed(row):
            inner = inner * q + real(a)
        total = total * p + inner
    return total
