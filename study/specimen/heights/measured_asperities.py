"""The answer of `measure`: the asperities of a scan, as parameters of the model, and in sentences."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.special import ndtri

from solver.laws.heights import CUT
from solver.parameters import ends

from ...terminal import rounded
from ..pictures import with_picture
from ..quantities import readable

#: Distribution of the summits' heights -> name of the micro law.
LAWS = {"normal": "normal_heights", "equal": "disc_cell"}


@dataclass(frozen=True)
class Roughness:
    """Asperities of a scan, by one method, after one filter, at one resolution: N̄ and Ra depend on all three.

    Attributes
    ----------
    Nbar : asperities per unit area, 1/m²
    Ra : radius of an asperity, 1/(mean curvature of the summits), m
    sigma_summits : standard deviation of the heights of the summits, m; also called `sigma`
    iso_Ra : mean deviation of the height from its mean, m: Ra of ISO 21920, Sa of ISO 25178. Not `Ra`.
    summits : number of summits that a scan of this size has; `cut` follows from it
    method, filter, resolution, notes : sentences; notes holds the doubts about this scan
    units : the unit of all lengths
    cutoff : None; or the cutoffs of a list, m, shape (C): all numbers are then arrays of this shape

    Examples
    --------
    >>> from study import roughness, samples
    >>> answer = roughness.measure(roughness.read(samples.scan()))
    >>> print(f"{answer.Nbar / 1e12:.4f} 1/um^2, {answer.Ra * 1e6:.1f} um, {answer.sigma * 1e9:.1f} nm")
    0.0732 1/um^2, 9.7 um, 41.9 nm
    """

    Nbar: Any
    Ra: Any
    sigma_summits: Any
    iso_Ra: Any
    summits: Any
    method: str
    filter: str
    resolution: str
    notes: tuple[str, ...] = ()
    units: str = "m"
    cutoff: np.ndarray | None = None

    @property
    def sigma(self) -> Any:
        """Standard deviation of the heights of the summits, m: `sigma_summits`."""
        return self.sigma_summits

    @property
    def cut(self) -> Any:
        """Height of the highest summit above the mean, over sigma, within the bounds of the law.

        1 - Φ(cut) = 1/N with N summits in the scan.
        """
        value = np.clip(-ndtri(1 / np.maximum(self.summits, 1.0)), *ends(CUT.interval)[:2])
        return value if self.cutoff is not None else float(value)

    def about_cut(self) -> str:
        """How `cut` of a single scan follows from its number of summits.

        Returns
        -------
        str : a sentence

        Examples
        --------
        >>> from study import roughness, samples
        >>> answer = roughness.measure(roughness.read(samples.scan()))
        >>> print(answer.about_cut().partition(";")[0])
        cut = 3, since the law takes 3 to 5
        """
        free, low, high = -ndtri(1 / max(self.summits, 1.0)), *ends(CUT.interval)[:2]
        number = f"{self.summits:.0f}" if self.summits < 1e6 else f"{self.summits:.3g}"
        source = f"1 - Φ(cut) = 1/N with the N = {number} summits of the scan"
        if low <= free <= high:
            return f"cut = {self.cut:.3g}, from {source}"
        return f"cut = {self.cut:.3g}, since the law takes {low:g} to {high:g}; {source} would give {max(free, 0):.3g}"

    def parameters(self, heights: str = "normal") -> dict[str, Any]:
        """The inputs of `study.solve`: Nbar, Ra and the micro law.

        Parameters
        ----------
        heights : "normal", for random surfaces: micro = "normal_heights" with sigma and cut; or "equal", for designed
            surfaces: micro = "disc_cell". Equal heights neglect that the highest summits touch first, and so give more
            real contact and a smaller p_max

        Returns
        -------
        dict : lengths are texts with units and all digits. With a list of cutoffs the numbers are DataArrays over
            `cutoff`

        Raises
        ------
        ValueError : unknown heights

        Examples
        --------
        >>> from study import roughness, samples
        >>> answer = roughness.measure(roughness.read(samples.scan()))
        >>> print(*answer.parameters(), answer.parameters()["micro"])
        Nbar Ra sigma cut micro normal_heights
        """
        if heights not in LAWS:
            raise ValueError(f'heights = {heights!r}; allowed are "normal" and "equal"')
        numbers = {"Nbar": self._with_unit(self.Nbar, "1/m^2"), "Ra": self._with_unit(self.Ra, "m")}
        if heights == "normal":
            numbers |= {"sigma": self._with_unit(self.sigma_summits, "m"), "cut": self._with_unit(self.cut, "")}
        return numbers | {"micro": LAWS[heights]}

    def _with_unit(self, value: Any, unit: str) -> Any:
        if self.cutoff is None:
            return f"{value!r} {unit}" if unit else value
        import xarray as xr

        wide = xr.DataArray(value, dims="cutoff", attrs={"units": unit} if unit else {})
        return wide.assign_coords(cutoff=("cutoff", self.cutoff, {"units": "m", "long_name": "cutoff of the low-pass"}))

    def _repr_html_(self) -> str:
        return with_picture(str(self))

    def __repr__(self) -> str:
        numbers = {"Nbar": self.Nbar, "Ra": self.Ra, "sigma": self.sigma, "cut": self.cut, "micro": LAWS["normal"]}
        numbers |= {} if self.cutoff is None else {"cutoff": self.cutoff}
        return f"Roughness({', '.join(f'{name}={value!r}' for name, value in numbers.items())}, notes={self.notes!r})"

    def __str__(self) -> str:
        lines = self._numbers() if self.cutoff is None else self._table()
        sentences = {"Resolution": self.resolution, "Filter": self.filter, "Method": self.method}
        lines += [f"{name}: {text}." for name, text in sentences.items()]
        return "\n".join(lines + [f"Note: {note}." for note in self.notes])

    def _numbers(self) -> list[str]:
        relief = 1 / (3 * math.pi * self.Nbar * self.Ra)
        return [
            f"N̄ = {density(self.Nbar)} (Nbar = {counted_density(self.Nbar)}): one asperity in a square of "
            f"{length(self.Nbar**-0.5)}.",
            f"Ra = {length(self.Ra)}, the radius of an asperity. The ISO roughness Ra (mean height) is "
            f"{length(self.iso_Ra)}: a different quantity.",
            f"sigma = {length(self.sigma_summits)}, the standard deviation of the summits' heights, and cut = "
            f'{self.cut:.3g}: parameters() gives these, for micro = "{LAWS["normal"]}".',
            f'Equal heights, parameters(heights="equal") with micro = "{LAWS["equal"]}", are for designed surfaces. '
            f"{_neglected(self)} They can be pressed down by {length(relief)} at most, 1/(3π N̄ Ra): "
            f"the spread of the heights is {rounded(self.sigma_summits / relief)} times that.",
        ]

    def _table(self) -> list[str]:
        rows = zip(self.cutoff, self.Nbar, self.Ra, self.sigma_summits, self.cut, strict=True)
        return [
            f"{len(self.cutoff)} cutoffs: the scan does not determine the numbers that change with them.",
            *(
                f"cutoff {length(c)}: N̄ = {density(Nbar)}, Ra = {length(Ra)}, sigma = {length(sigma)}, cut = {cut:.3g}."
                for c, Nbar, Ra, sigma, cut in rows
            ),
            f'parameters() gives these, for micro = "{LAWS["normal"]}". Equal heights, parameters(heights="equal") '
            f'with micro = "{LAWS["equal"]}", are for designed surfaces. {_neglected(self)}',
        ]


def over(cutoffs: Sequence[float], answers: Sequence[Roughness], filtered: str) -> Roughness:
    """One answer for several cutoffs: its numbers are arrays.

    filtered : the treatment of the heights at all cutoffs, in words

    A note that does not hold at every cutoff begins with the cutoffs at which it holds.
    """
    numbers = {
        name: np.array([getattr(answer, name) for answer in answers])
        for name in ("Nbar", "Ra", "sigma_summits", "iso_Ra", "summits")
    }
    every = dict.fromkeys(note for answer in answers for note in answer.notes)
    where = {note: [c for c, answer in zip(cutoffs, answers, strict=True) if note in answer.notes] for note in every}
    notes = tuple(note if len(at) == len(answers) else f"{_at(at)}: {note}" for note, at in where.items())
    method = "; ".join(f"{_at([c])}: {answer.method}" for c, answer in zip(cutoffs, answers, strict=True))
    texts = {"method": method, "filter": filtered, "notes": notes}
    return replace(answers[0], **numbers, **texts, cutoff=np.array(cutoffs, dtype=float))


def _at(cutoffs: Sequence[float]) -> str:
    return f"at the cutoff{'s' * (len(cutoffs) > 1)} {', '.join(map(length, cutoffs))}"


def _neglected(roughness: Roughness) -> str:
    """A sentence on the error of equal heights on a random surface."""
    if np.all(roughness.sigma_summits * 3 * math.pi * roughness.Nbar * roughness.Ra < 0.01):
        return "Here the heights are equal, and both laws are one."
    return "They neglect that the highest summits touch first: real contact comes out too large, and p_max too small."


def length(x: float) -> str:
    """A length as text, in m, mm, µm or nm, to three digits."""
    return readable(float(f"{x:.3g}"), "m")


def density(Nbar: float) -> str:
    """Asperities per unit area as text, to three digits."""
    per_area, unit = (Nbar / 1e12, "µm⁻²") if Nbar >= 1e10 else (Nbar / 1e6, "mm⁻²")
    return f"{rounded(per_area, 3)} {unit}"


def counted_density(Nbar: float) -> str:
    """Asperities per unit area as people write and compare them, to four digits: "12,510 1/mm²"; above 1e6 in 1/µm²."""
    per_area, unit = (Nbar / 1e6, "1/mm²") if Nbar < 1e12 else (Nbar / 1e12, "1/µm²")
    return f"{float(f'{per_area:.4g}'):,.10g} {unit}"
