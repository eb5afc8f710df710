"""The tables of solver/compiled/bessel.h, from 40 digits: `python tools/make_bessel.py` prints them.

Below x = 8, J0(x) and J1(x)/x are polynomials of t = x²/32 - 1. Above, with u = (8/x)² and χ = x - mπ/2 - π/4,
J_m(x) = sqrt(2/(πx)) (P_m(u) cos χ - 8/x Q_m(u) sin χ), and P_m, Q_m are polynomials of u.
"""

from collections.abc import Callable

from mpmath import besselj, bessely, cos, fsum, mp, mpf, pi, sin, sqrt

#: Degrees of the polynomials: one less adds more than 1e-17.
NEAR, FAR = 16, 11


def interpolated(function: Callable, degree: int) -> list:
    """Coefficients, the highest power first, of the polynomial of t in [-1, 1] through the Chebyshev points."""
    count = degree + 1
    angles = [pi * (2 * j + 1) / (2 * count) for j in range(count)]
    values = [function(cos(angle)) for angle in angles]
    series = [
        2 * fsum(v * cos(m * angle) for v, angle in zip(values, angles, strict=True)) / count for m in range(count)
    ]
    before, last, total = [mpf(1)], [mpf(0), mpf(1)], [series[0] / 2, *[mpf(0)] * degree]
    for factor in series[1:]:
        total = [a + factor * b for a, b in zip(total, last + [mpf(0)] * (count - len(last)), strict=True)]
        after = [mpf(0), *(2 * v for v in last)]
        before, last = last, [a - b for a, b in zip(after, [*before, 0, 0], strict=True)]
        last = last[:count]
    return total[::-1]


def of_unit(coefficients: list) -> list:
    """The same polynomial as one of u = (t + 1)/2."""
    total = [mpf(0)]
    for c in coefficients:
        total = [a - b for a, b in zip([2 * v for v in total] + [mpf(0)], [mpf(0), *total], strict=True)]
        total[-1] += c
    return total[1:]


def near(m: int) -> list:
    def of(t):  # type: ignore[no-untyped-def]
        x = sqrt(32 * (1 + t))
        return besselj(m, x) / x**m

    return interpolated(of, NEAR)


def far(m: int) -> tuple[list, list]:
    def at(t):  # type: ignore[no-untyped-def]
        x = 8 / sqrt((1 + t) / 2)
        angle = x - (2 * m + 1) * pi / 4
        return x, angle, sqrt(pi * x / 2) * besselj(m, x), sqrt(pi * x / 2) * bessely(m, x)

    def P(t):  # type: ignore[no-untyped-def]
        _, angle, J, Y = at(t)
        return J * cos(angle) + Y * sin(angle)

    def Q(t):  # type: ignore[no-untyped-def]
        x, angle, J, Y = at(t)
        return (Y * cos(angle) - J * sin(angle)) * x / 8

    return of_unit(interpolated(P, FAR)), of_unit(interpolated(Q, FAR))


def tables() -> dict[str, list[list]]:
    """Name -> rows of numbers, one row for each power, the highest first."""
    mp.dps = 40
    columns = {"NEAR": [near(0), near(1)], "FAR": [*far(0), *far(1)]}
    return {name: [list(row) for row in zip(*lists, strict=True)] for name, lists in columns.items()}


def main() -> None:
    for name, rows in tables().items():
        print(f"static const double {name}[{len(rows)}][{len(rows[0])}] = {{")
        for row in rows:
            print("    {" + ", ".join(f"{float(value)!r}" for value in row) + "},")
        print("};")


if __name__ == "__main__":
    main()
