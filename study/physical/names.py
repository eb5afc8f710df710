"""What a physical scene has, in which SI unit each of its numbers is, and how they are found by text."""

from typing import Any

from xarray.indexes import PandasIndex

from ..scene.quantities import has_unit, quantity
from ..spec.vocabulary import VOCABULARY

#: What a scene has besides the parameters of the solver: SI unit and long name.
SCENE = {
    "R": ("m", "radius of the punch"),
    "E1": ("Pa", "Young's modulus of the layer"),
    "E2": ("Pa", "Young's modulus of the body under the layer"),
    "E_punch": ("Pa", "Young's modulus of the punch"),
    "nu_punch": ("1", "Poisson ratio of the punch"),
}
#: Powers of E2* and R -> SI unit.
UNITS = {(0, 0): "1", (0, 1): "m", (0, 2): "m^2", (0, -2): "1/m^2", (1, 0): "Pa", (1, 1): "N/m", (1, 2): "N"}


def unit_of(name: str) -> str:
    """SI unit of a parameter or result, as in READABLE; "1" for pure numbers and texts."""
    return SCENE[name][0] if name in SCENE else UNITS[VOCABULARY[name].powers]


class UnitIndex(PandasIndex):
    """An index of SI numbers in which `sel(h="3 um")`, and slices of such texts, find 3e-6."""

    def sel(self, labels: dict, method=None, tolerance=None):
        """As of any index of xarray. Raises ValueError for a text with no unit, or with one of something else."""
        name, label = next(iter(labels.items()))

        def number(one: Any) -> Any:
            return quantity(name, one, unit_of(name)).value if isinstance(one, str) or has_unit(one) else one

        if isinstance(label, slice):
            label = slice(number(label.start), number(label.stop), label.step)
        else:
            label = [number(one) for one in label] if isinstance(label, (list, tuple)) else number(label)
        return super().sel({name: label}, method=method, tolerance=tolerance)
