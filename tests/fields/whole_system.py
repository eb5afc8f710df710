"""The states of layers and body under a wave as one linear system in 60 digits, of all conditions at once."""

import mpmath as mp


def decaying(x, nu):
    """H(x) of docs/stress_fields.md."""
    rows = [[1 - 2 * nu - x, -2 * (1 - nu) + x], [-2 * (1 - nu) - x, 1 - 2 * nu + x], [1 + x, -x], [x, 1 - x]]
    return mp.exp(-x) * mp.matrix(rows)


def growing(y, nu):
    return mp.diag([1, -1, 1, -1]) * decaying(y, nu) * mp.diag([1, -1])


def state(layers, faces, nu2, rigid, k, load, points):
    """u, w, S, T at (region, z) of `points`, lists of 4 numbers.

    layers : (h, n, nu), the top first; faces : "bonded", "frictionless" or (cn, ct) below each
    """
    k, N = mp.mpf(k), len(layers)
    with mp.workdps(60 + int(3 * k * sum(h for h, _, _ in layers))):
        h, n, nu = ([mp.mpf(float(v)) for v in column] for column in zip(*layers, strict=True))
        nu2 = mp.mpf(float(nu2))
        G2 = [n[j] * (1 - nu[j]) for j in range(N)] + [1 - nu2]
        size = 4 * N + (0 if rigid else 2)
        A, right, rows = mp.zeros(size), mp.zeros(size, 1), iter(range(size))

        def both(j, x, y):
            down, up = decaying(x, nu[j]), growing(y, nu[j])
            return [[down[i, 0], down[i, 1], up[i, 0], up[i, 1]] for i in range(4)]

        def condition(j, above, below, lower):
            row = next(rows)
            for first, factors, values in ((4 * j, above, both(j, k * h[j], 0)), (4 * j + 4, below, lower)):
                for column in range(len(values[0]) if values else 0):
                    A[row, first + column] = sum(f * value[column] for f, value in zip(factors, values, strict=True))

        surface = both(0, 0, k * h[0])
        for i in (2, 3):
            row = next(rows)
            right[row] = load[i - 2]
            for column in range(4):
                A[row, column] = surface[i][column]
        for j, face in enumerate(faces):
            last, free = j == N - 1, face == "frictionless"
            stuck, cn, ct = last and rigid, *((0, 0) if isinstance(face, str) else map(mp.mpf, face))
            of_body = decaying(0, nu2)
            body = [] if stuck else [[of_body[i, 0], of_body[i, 1]] for i in range(4)]
            lower = body if last else both(j + 1, 0, k * h[j + 1])
            condition(j, [0, 1 / G2[j], k * cn, 0], [0, -1 / G2[j + 1], 0, 0], lower)
            condition(j, [0, 0, 0, 1] if free else [1 / G2[j], 0, 0, k * ct], [-(not free) / G2[j + 1], 0, 0, 0], lower)
            if not stuck:
                condition(j, [0, 0, 0, not free], [0, 0, 0, -1], lower)
                condition(j, [0, 0, 1, 0], [0, 0, -1, 0], lower)
        x, made = mp.lu_solve(A, right), []
        for region, z in points:
            depth, own = (
                mp.mpf(float(z)) - sum(h[:region]),
                [x[i] for i in range(4 * region, min(4 * region + 4, size))],
            )
            columns = decaying(k * depth, nu2 if region == N else nu[region]) * mp.matrix(own[:2])
            if region < N:
                columns += growing(k * (h[region] - depth), nu[region]) * mp.matrix(own[2:])
            made.append([float(v) for v in columns])
        return made
