"""Fields of stacks: reference rows, the states against one linear system in 60 digits, and layers of one material."""

import numpy as np
import pytest
import whole_system
from field_rows import FOLDER, SHAPES, body_of, table
from numpy.testing import assert_allclose

from solver.fields import of_pressure
from solver.kernels.stack import Stack

HERTZ = SHAPES[0]
NORMAL = ("sr", "st", "sz", "trz")
SLIDING = ("sr_c", "st_c", "sz_c", "srt_s", "sxz_0", "sxz_2")
DISPLACEMENTS = ("ur", "uz", "uz_c", "ux_0", "ux_2")


def as_layers(body):
    """The arguments of one layer as a stack."""
    rigid = body["n"] == 0
    return {
        "layers": [(body["h"], 1.0 if rigid else body["n"], body["nu1"])],
        "interfaces": [body["bonding"]],
        "nu2": body["nu2"],
        "rigid_base": rigid,
    }


def test_reference():
    """To 1e-12 of the largest stress of each stack; the rows have 12 decimals."""
    lines = (FOLDER / "stack_stress.csv").read_text(encoding="utf-8").splitlines()[1:]
    stacks = {}
    for line in lines:
        *key, r, z, layer, sr, st, sz, trz, _ = line.split(",")
        stacks.setdefault(tuple(key), []).append([float(v) for v in (r, z, layer, sr, st, sz, trz)])
    assert len(stacks) == 8
    for key, rows in stacks.items():
        h, n, nu = ([float(v) for v in column.split()] for column in key)
        rows = np.array(rows)
        layers = list(zip(h, n, nu[:-1], strict=True))
        for side in np.unique(rows[:, 2]):
            r, z, _, *wanted = rows[rows[:, 2] == side].T
            field = of_pressure(HERTZ, r, z, layers=layers, nu2=nu[-1], side=int(side))
            computed = np.array([field[name] for name in NORMAL])
            assert_allclose(computed, wanted, rtol=0, atol=1e-12 * np.abs(rows[:, 3:]).max())


@pytest.mark.parametrize("seed", range(6))
def test_states(seed):
    """u, w, S, T relative to the largest in the layer, or to the load; of random layers, moduli and springs."""
    random = np.random.default_rng(seed)
    N, contrast = random.integers(1, 5), random.choice([1, 2, 4])
    h, n = 10 ** random.uniform(-2, 2, N), 10 ** random.uniform(-contrast, contrast, N)
    nu, nu2 = np.where(random.random(N) < 0.2, 0.5, random.uniform(-0.5, 0.5, N)), random.uniform(-0.5, 0.5)
    rigid = seed % 3 == 0
    n = n / n[0] if rigid else n
    springs = [(float(a), float(b)) for a, b in 10 ** random.uniform(-3, 3, (N, 2))]
    faces = [("bonded", "frictionless", springs[j])[random.integers(3)] for j in range(N)]
    free = np.array([[face == "frictionless" for face in faces]])
    cn, ct = (np.array([[0.0 if isinstance(face, str) else face[i] for face in faces]]) for i in (0, 1))
    unit = n[0] / h[0]
    stack = Stack(n[None], nu[None], h[None] / h[0], free, cn * unit, ct * unit, np.array([nu2]), np.array([rigid]))
    k, tops = np.sort(10 ** random.uniform(-3, 1.3, 3)) / h.sum(), np.append(0.0, np.cumsum(h))
    layers = list(zip(h, n, nu, strict=True))
    for load in ((-1.0, 0.0), (0.0, 1.0)):
        waves = stack.waves(k, h[:1], load)
        for i, at in enumerate(k):
            for region in range(N + (not rigid)):
                z = tops[region] + (h[region] * np.array([0, 0.4, 1.0]) if region < N else np.array([0.0, 1 / at]))
                wanted = whole_system.state(layers, faces, nu2, rigid, at, load, [(region, depth) for depth in z])
                computed = np.array(waves.state(region, z[None]))[:, 0, :, i].T
                size = max(1.0, np.abs(wanted).max())
                assert_allclose(computed, wanted, rtol=0, atol=1e-11 * size)


@pytest.mark.parametrize("seed", range(4))
def test_waves_across_the_plane(seed):
    """Q and v' obey Q' = v'/2, v'' = 2 Q, go on at bonded interfaces, and springs yield by ct."""
    random = np.random.default_rng(seed)
    N = 3
    h, n, nu = 10 ** random.uniform(-1, 1, N), 10 ** random.uniform(-2, 2, N), random.uniform(0, 0.5, N)
    ct = np.array([0.0, 10 ** random.uniform(-1, 1), 0.0])
    none, base = np.zeros((1, N)), (np.array([0.3]), np.array([False]))
    stack = Stack(n[None], nu[None], h[None] / h[0], none > 0, none, ct[None] * n[0] / h[0], *base)
    k, tops, G = 10 ** np.linspace(-3, 1, 9) / h.sum(), np.append(0.0, np.cumsum(h)), stack.shear[0]
    waves = stack.waves(k, h[:1], (0.0, 1.0))
    for region in range(N + 1):
        for i, at in enumerate(k):
            step = min(0.02 / at, (h[region] if region < N else np.inf) / 5)
            Q, across = waves.antiplane(region, tops[region] + step * np.arange(5)[None])[:, 0, :, i]
            weights, size = np.array([1, -8, 0, 8, -1]) / (12 * step * at), np.abs([Q, across]).max()
            assert_allclose(
                [weights @ Q, weights @ across],
                [across[2] / 2, 2 * Q[2]],
                rtol=0,
                atol=size * (1e-7 + 1e-14 / step / at),
            )
    assert_allclose(waves.antiplane(0, np.zeros((1, 1)))[0, 0, 0], 1.0, rtol=1e-14)
    for j in range(N):
        above, below = (waves.antiplane(region, tops[None, j + 1 : j + 2])[:, 0, 0] for region in (j, j + 1))
        assert_allclose(below[0], above[0], rtol=1e-12)
        assert_allclose(below[1] / G[j + 1] - above[1] / G[j], k * ct[j] * above[0], rtol=1e-9, atol=1e-12 / G.min())


@pytest.mark.parametrize("config", ["G1", "G3", "G5", "G7"])
@pytest.mark.parametrize(("file", "mu"), [("stress_normal", 0.0), ("stress_friction", 1.0)])
def test_one_layer(config, file, mu):
    """Is what h, n, nu1 and bonding give, to 1e-13 of the largest; cut into three it is the same layer."""
    rows = table(file)
    rows = rows[rows["config"] == config]
    body = body_of(rows[0])
    stack = as_layers(body)
    h, n, nu = stack["layers"][0]
    cut = stack | {
        "layers": [(share * h, n, nu) for share in (0.2, 0.5, 0.3)],
        "interfaces": ["bonded", (0.0, 0.0), *stack["interfaces"]],
    }
    for side in np.unique(rows["side"]):
        here = rows[rows["side"] == side]
        shape = SHAPES[here["shape"][0]]
        wanted = of_pressure(shape, here["r"], here["z"], **body, mu=mu, side=("layer", "base")[side])
        assert bool(mu) == ("ux_0" in wanted)
        for stacked, number in ((stack, 1 + side), (cut, 3 + side)):
            field = of_pressure(shape, here["r"], here["z"], **stacked, mu=mu, side=int(number))
            for names in (NORMAL + SLIDING, DISPLACEMENTS):
                size = np.nanmax(np.abs([wanted[name] for name in names if name in wanted]), initial=1.0)
                for name in names if mu else names[:4]:
                    if name in wanted:
                        assert_allclose(field[name], wanted[name], rtol=0, atol=1e-13 * size, err_msg=name)


def test_equal_layers_are_the_half_space():
    r, z = np.array([0.0, 0.6, 1.0, 1.4])[:, None], np.array([0.0, 0.01, 0.3, 0.9])
    wanted = of_pressure(HERTZ, r, z, h=7.0, n=1.0, nu1=0.3, nu2=0.3, bonding="bonded", mu=0.4)
    field = of_pressure(HERTZ, r, z, layers=[(0.005, 1.0, 0.3), (0.2, 1.0, 0.3), (0.4, 1.0, 0.3)], nu2=0.3, mu=0.4)
    for name, values in wanted.items():
        assert_allclose(field[name], values, rtol=0, atol=2e-13, err_msg=name)


def test_conditions_at_interfaces():
    """Stresses go on, springs open by their compliance, nothing is dragged without friction, rigid bodies have NaN."""
    layers, faces = [(0.1, 5.0, 0.2), (0.2, 0.1, 0.45), (0.3, 2.0, 0.3)], ["frictionless", (0.3, 0.2), "bonded"]
    r = np.array([0.0, 0.5, 1.0, 1.7])
    for rigid in (False, True):
        stack = {"interfaces": faces, "nu2": 0.25, "rigid_base": rigid}
        stack["layers"] = [(h, n / (layers[0][1] if rigid else 1.0), nu) for h, n, nu in layers]
        for number, z in ((1, 0.1), (2, 0.3), (3, 0.6)):
            above, below = (of_pressure(HERTZ, r, z, **stack, side=side) for side in (number, number + 1))
            if number == 3 and rigid:
                assert all(np.isnan(values).all() for values in below.values())
                assert_allclose([above["ur"], above["uz"]], 0.0, rtol=0, atol=1e-13)
                continue
            cn, ct = faces[number - 1] if number == 2 else (0.0, 0.0)
            for name in ("sz", "trz"):
                assert_allclose(above[name], below[name], rtol=0, atol=1e-12)
            assert_allclose(below["uz"] - above["uz"], cn * above["sz"], rtol=0, atol=1e-12)
            if number == 1:
                assert np.all(np.abs(above["trz"]) < 1e-15) and np.abs(below["ur"] - above["ur"]).max() > 0.01
            else:
                assert_allclose(below["ur"] - above["ur"], ct * above["trz"], rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"layers": []}, "list of 1 to 16"),
        ({"layers": [(0.1, 2.0)]}, r"layers\[1\]"),
        ({"layers": [(0.1, 2.0, 0.3), (0.1, -2.0, 0.3)]}, r"layers\[2\]: n = -2"),
        ({"layers": [(0.1, 2.0, 0.6)]}, r"layers\[1\]: nu = 0.6"),
        ({"interfaces": ["bonded", "bonded"]}, "list of 1, one below each"),
        ({"interfaces": ["glued"]}, r"interfaces\[1\] = 'glued'"),
        ({"interfaces": [(-1.0, 0.0)]}, r"interfaces\[1\]: cn = -1"),
        ({"rigid_base": True}, "that of the first layer is 1"),
        ({"nu2": None}, "nu2 = None"),
        ({"side": 3}, "number of a body, 1 to 2"),
        ({"side": "layer"}, "number of a body, 1 to 2"),
        ({"h": 0.1}, "h is given"),
        ({"bonding": "bonded"}, "bonding is given"),
    ],
)
def test_refused(changed, words):
    with pytest.raises(ValueError, match=words):
        of_pressure(HERTZ, 0.0, 0.1, **{"layers": [(0.1, 2.0, 0.3)], "nu2": 0.3} | changed)


def test_refused_of_one_layer():
    with pytest.raises(ValueError, match="interfaces is given"):
        of_pressure(HERTZ, 0.0, 0.1, h=0.1, n=2.0, nu1=0.3, nu2=0.3, bonding="bonded", interfaces=["bonded"])
