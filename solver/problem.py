"""The problem: arrays over a batch of cases."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import layers
from .bases import FELT, is_bare, is_stack
from .known import Known, default, names_of
from .laws import Law
from .numerics.caches import once
from .parameters import COMMON, CONTROL, Parameter, allowed, among, one_of

#: A pitch that exceeds h only by rounding is not above it, whatever the units: Nbar h² must be below this.
_ABOVE = 1 - 1e-9
#: Largest |P| or |D| under adhesion, in units R = E2* = 1: the upper bound of P and D in solver/parameters.py.
_PULL = 1e3


@dataclass(frozen=True)
class Problem:
    """A batch of B cases. `value` and each of the `parameters`, which are attributes too, are arrays (B,). :meth:`of`
    makes a batch.

    Lengths are in the unit of `R`, moduli in that of `E2`, loads in that of E2 R², `Nbar` in that of R⁻²; with R = E2 =
    1 these are the units of the paper. The bounds are in solver/parameters.py. Parameters with a default below are
    optional; the others must be given if a case needs them. Registered laws have further parameters.

    Attributes
    ----------
    control, value : the quantity that is given, "P", "a" or "D", and its value: load, radius of the nominal contact
        area or indentation depth
    h, n : thickness of the layer, and ratio of the reduced moduli E1*/E2*; needed by every base except "half_space".
        n = 0 is a rigid base. Its E2* is infinite, so that E1* is the unit of moduli, and `E2` means E1*
    m = 0 : ratio of the reduced moduli E1*/E3* of layer and punch (E2*/E3* without a layer); 0 is a rigid punch. The
        displacements of both bodies add; D is the approach of their distant points
    nu1, nu2 = 0.3 : Poisson ratios of layer and half-space. If the interface is frictionless, they change nothing
    Y1, Y2, Y_punch : yield strengths of layer, half-space and punch, if they are known; they change no answer
    bonding = "frictionless" : the interface between layer and half-space; or "bonded"
    Nbar, Ra : asperities per unit area, and their radius; needed by the micro laws that declare them, which are all of
        this package except "smooth"
    base = "layered" : the exact layer on a half-space; "half_space", without a layer; "thin_layer", the thin layer of
        Eq. (3); "auto", the cheapest of these that is accurate enough
    accuracy = 0.01 : allowed relative model error of the base "auto"
    model_check = "closed_form" : `model_error` of the base "thin_layer" is estimated at no cost; "first_order", by
        solving the exact layer, from the solution, on a coarse mesh
    micro = "disc_cell" : the law of Eqs (6) and (7); "smooth", no asperities; "power_law", A = B Ra (p/E1*)^beta (E2*
        without a layer); "square_lattice", "hex_lattice"; "normal_heights", "uniform_heights"; "elastic_plastic", the
        first with asperities that yield while the load rises; or the name of a registered law, or a
        `solver.Law` itself
    asperities_on = "auto" : the body on which asperities press: "layer", the coated body itself; "half_space", one of
        the layer's material; "auto", the coated body if their pitch 1/sqrt(Nbar) is above h. On thin layers, and with
        "power_law" and tables, it is always the half-space
    hardness, yield_strength : for "elastic_plastic", those of the softer of two bodies, the asperity and the body under
        it. One of them is enough: the hardness is then 2.84 times the yield strength
    B, beta : coefficient, without unit, and exponent of the "power_law"
    sigma, cut = 4 : standard deviation of random heights; and for "normal_heights" the largest height above their mean,
        over sigma
    shape = "paraboloid" : r²/(2R); or "sphere", "cone", "power", "frustum", "blunt_cone", "flat", "rounded_flat",
        "berkovich", "vickers", "cube_corner", or "table:FILE.csv" of r and f; each is a file of solver/shapes
    half_angle : angle of a cone, from its axis to its side, in degrees
    flat_radius, tip_radius, edge_radius : radius of the flat part around the axis, of a round tip, of a round edge
    tip = "paraboloid" : the round tip of a "blunt_cone"; or "sphere"
    shape_power, shape_coefficient : k and c of f/R = c (r/R)^k
    table_unit : the length that 1 stands for in a table of a shape; R by default
    w_adhesion = 0 : work of adhesion of smooth punches, in the unit of E2 R; load and depth may then be negative
    adhesion = "jkr" : attraction only at the edge; "dmt", only outside the contact; "maugis", with the stress `sigma0`
        or the range `z0` = w_adhesion/(0.97 sigma0)
    branch = "stable" : of two states with the same load or depth, the one with the larger radius; or "unstable"
    k_machine : stiffness of the machine that holds the punch, in the unit of E2 R; by default 0 (a dead load) when P or
        a is given, and infinite when D is
    scheme = "newton" : Newton's method; "picard", the paper's successive approximations, Eqs (8) and (10), which solve
        no smooth case; k = 1 : their relaxation
    rtol = 1e-6 : largest allowed relative error of a, P, D, p0, p_max, Ar_An
    nodes = 0 : number of nodes; 0: chosen by `rtol`
    max_iterations = 0 : most steps on a mesh, or approximations at one radius; 0: the limit of the scheme
    R, E2 = 1 : radius of the punch, and reduced modulus E2* of the half-space, both > 0, in any units
    known : the vocabulary of the parameters: laws, shapes and profiles by their names (solver/known)

    Examples
    --------
    >>> Problem.of(P=[1e-5, 2e-5], base="half_space", micro="smooth")
    Problem(2 cases, P = 1e-05 ... 2e-05, base: half_space, micro: smooth)
    """

    control: str
    value: np.ndarray
    parameters: dict[str, np.ndarray]
    known: Known

    def __repr__(self):
        control = f"{self.control} = {self.value.min():g} ... {self.value.max():g}" if len(self) else self.control
        kinds = [", ".join(sorted(set(values.tolist()))) for values in (self.base, self.micro)]
        return f"Problem({len(self)} cases, {control}, base: {kinds[0]}, micro: {kinds[1]})"

    def __getstate__(self):
        """Laws and tables that no case uses are not pickled, nor are their parameters."""
        known = self.known.only(self.parameters)
        parameters = {name: values for name, values in self.parameters.items() if name in known.parameters}
        return {"control": self.control, "value": self.value, "parameters": parameters, "known": known}

    def __getattr__(self, name):
        """A parameter; NaN if the vocabulary has it, and this batch was made without it."""
        if name in (parameters := self.__dict__.get("parameters", {})):
            return parameters[name]
        if "known" not in self.__dict__ or name not in self.known.parameters:
            raise AttributeError(f"Problem has no {name}")
        return np.full(len(self), np.nan)

    @classmethod
    def of(
        cls,
        *,
        P: ArrayLike | None = None,
        a: ArrayLike | None = None,
        D: ArrayLike | None = None,
        known: Known | None = None,
        **parameters: Any,
    ) -> "Problem":
        """Broadcast scalars and (B,) arrays to a batch.

        A parameter that is not given has its default, or is NaN if no case needs it. A number out of bounds, NaN, and
        the scheme "picard" for a smooth case raise no error: that case gets ``Status.INVALID_INPUT``.

        Parameters
        ----------
        P, a, D : load, radius of the nominal contact area, indentation depth; exactly one of them
        known : laws, shapes and tables of profiles by the names that the parameters use; None: those of this package
            and those that the program has registered. Laws that are given as objects, and tables, are added
        parameters : as in the docstring of the class

        Returns
        -------
        Problem

        Raises
        ------
        TypeError : a parameter does not exist
        ValueError : not exactly one control; a parameter is missing that some case needs; shapes do not broadcast to
            (B,); a text is not one of its choices

        Examples
        --------
        >>> Problem.of(P=[1e-5, 2e-5], Nbar=250000, Ra=0.004, base="half_space").h
        array([nan, nan])
        >>> Problem.of(P=1e-5, n=0.5, Nbar=250000, Ra=0.004)
        Traceback (most recent call last):
        ValueError: h is missing: base = "layered" needs it
        """
        controls = {name: v for name, v in zip(CONTROL, (P, a, D), strict=True) if v is not None}
        if len(controls) != 1:
            raise ValueError(f"give exactly one of P, a, D (got {', '.join(controls) or 'none'})")
        ((control, value),) = controls.items()
        parameters = {"micro": COMMON["micro"].default} | layers.expanded(parameters)
        known = (known or default()).with_profiles(parameters).with_tips(parameters.get("shape", ()))
        known = known.with_laws_of(parameters["micro"], parameters)
        parameters["micro"] = names_of(parameters["micro"])
        table = known.table(layers.numbers_of(parameters))
        unknown = sorted(set(parameters) - set(table))
        if unknown:
            raise TypeError(f"unknown parameter {unknown[0]}")
        defaults = {name: np.nan if row.default is None else row.default for name, row in table.items()}
        arrays = {name: _array(name, v, table) for name, v in ({"value": value} | defaults | parameters).items()}
        shape = np.broadcast_shapes((1,), *(v.shape for v in arrays.values()))
        if len(shape) != 1:
            raise ValueError(f"parameters broadcast to shape {shape}: give scalars and one-dimensional arrays")
        if missing := "; ".join(_missing(parameters, arrays, table)):
            raise ValueError(missing)
        arrays = {name: np.broadcast_to(v, shape) for name, v in arrays.items()}
        return cls(control, arrays.pop("value"), arrays, known)

    def __len__(self):
        return len(self.value)

    # one contact asks for these several times
    _rough = once(lambda self: ~one_of(self.micro, [word for word, law in self.known.laws.items() if not law.rough]))
    _felt = once(lambda self: feels(self.base, self.micro, self.asperities_on, self.Nbar, self.h, self.known.laws))

    def take(self, index: Any) -> "Problem":
        """Some of the cases.

        Parameters
        ----------
        index : whole numbers, a slice, or bool (B,)

        Returns
        -------
        Problem

        Examples
        --------
        >>> Problem.of(P=[1e-5, 2e-5, 4e-5], base="half_space", micro="smooth").take([0, 2]).value.tolist()
        [1e-05, 4e-05]
        """
        parameters = {name: v[index] for name, v in self.parameters.items()}
        return Problem(self.control, self.value[index], parameters, self.known)

    def but(self, **parameters: Any) -> "Problem":
        """The batch with other values of some parameters.

        Parameters
        ----------
        parameters : (B,) each, or one value for all cases

        Returns
        -------
        Problem

        Examples
        --------
        >>> Problem.of(P=1e-5, base="half_space", micro="smooth").but(nu2=0.4).nu2.tolist()
        [0.4]
        """
        new = {name: np.broadcast_to(v, len(self)) for name, v in parameters.items()}
        return Problem(self.control, self.value, self.parameters | new, self.known)

    @property
    def nu(self) -> np.ndarray:
        """Poisson's ratio (B,) of the layer, on which the asperities press, or of the body if there is no layer."""
        return np.where(is_bare(self.base), self.nu2, self.nu1)

    def rough(self) -> np.ndarray:
        """Which cases are rough.

        Returns
        -------
        numpy.ndarray : (B,) bool, whether the case has asperities

        Examples
        --------
        >>> Problem.of(P=1e-5, base="half_space", micro="smooth").rough().tolist()
        [False]
        """
        return self._rough.copy()

    def can_feel(self) -> np.ndarray:
        """Which cases have asperities that can feel the coated body.

        Returns
        -------
        numpy.ndarray : (B,) bool: the base is an exact layer or stack, or "auto", and the micro law takes its kernel

        Examples
        --------
        >>> Problem.of(P=1e-5, h=0.02, n=2, Nbar=1e5, Ra=0.004, base=["layered", "thin_layer"]).can_feel().tolist()
        [True, False]
        """
        return can_feel(self.base, self.micro, self.known.laws)

    def feels_layer(self) -> np.ndarray:
        """Which cases have asperities that feel the coated body.

        Returns
        -------
        numpy.ndarray : (B,) bool: they can, and `asperities_on` is "layer", or it is "auto" and their pitch is above h

        Examples
        --------
        >>> Problem.of(P=1e-5, h=0.02, n=0.5, Nbar=[250000, 1000], Ra=0.004).feels_layer().tolist()  # pitch < h, > h
        [False, True]
        """
        return self._felt.copy()

    def may_pull(self) -> np.ndarray:
        """Which cases may have a control that is 0 or negative.

        Returns
        -------
        numpy.ndarray : (B,) bool: there is adhesion, and P or D is given

        Examples
        --------
        >>> Problem.of(P=-1e-6, base="half_space", micro="smooth", w_adhesion=1e-5).may_pull().tolist()
        [True]
        """
        return (self.w_adhesion > 0) & (self.control != "a")

    def without_scheme(self) -> np.ndarray:
        """Which cases have a scheme that cannot solve them.

        Returns
        -------
        numpy.ndarray : (B,) bool: the case is smooth and its scheme is "picard", which is for asperities

        Examples
        --------
        >>> Problem.of(P=1e-5, base="half_space", micro="smooth", scheme="picard").without_scheme().tolist()
        [True]
        """
        return (self.scheme == "picard") & ~self.rough()

    def invalid(self) -> np.ndarray:
        """Which cases have an invalid number. The bounds are those of a problem in units R = E2* = 1.

        Returns
        -------
        numpy.ndarray : (B,) bool: a number that the case needs is not finite or out of bounds, or those of its micro
            law do not go together; or `asperities_on` is "layer", but the asperities cannot feel it

        Examples
        --------
        >>> Problem.of(P=[1e-5, -1.0], base="half_space", micro="smooth").invalid().tolist()
        [False, True]
        """
        bad = ~(allowed(CONTROL[self.control], self.value) | self.may_pull() & (np.abs(self.value) <= _PULL))
        bad |= (self.asperities_on == "layer") & ~self.can_feel()
        needing = {}
        for name, row in self.known.table(layers.numbers_of(self.parameters)).items():
            if row.interval:
                if row.needed_by not in needing:
                    needing[row.needed_by] = among(row.needed_by, lambda name: getattr(self, name))
                if not needing[row.needed_by].any():
                    continue
                values = getattr(self, name)
                left_out = np.isnan(values) & (row.instead is not None)
                bad |= needing[row.needed_by] & ~(allowed(row, values) | left_out)
        for law in self.known.laws.values():
            index = np.flatnonzero(self.micro == law.name) if law.allows else ()
            if law.allows and len(index):
                bad[index] |= ~law.allows(**{name: getattr(self, name)[index] for name in law.arguments})
        return bad


def far_apart(Nbar: ArrayLike, h: ArrayLike) -> np.ndarray:
    """Whether the pitch 1/sqrt(Nbar) of asperities is above the thickness of the layer.

    Parameters
    ----------
    Nbar, h : in the same unit of length, any; they broadcast. NaN gives False

    Returns
    -------
    numpy.ndarray of bool
    """
    with np.errstate(invalid="ignore", over="ignore"):
        return np.asarray(Nbar) * np.asarray(h) ** 2 < _ABOVE


def can_feel(base: ArrayLike, micro: ArrayLike, laws: Mapping[str, Law]) -> np.ndarray:
    """Whether asperities can feel the coated body.

    Parameters
    ----------
    base, micro : words; they broadcast
    laws : name -> law, for the words of `micro`

    Returns
    -------
    numpy.ndarray of bool : the base is an exact layer or stack, or "auto", and the micro law takes its kernel
    """
    return one_of(base, FELT) & one_of(micro, [name for name, law in laws.items() if law.on_body])


def feels(
    base: ArrayLike, micro: ArrayLike, asperities_on: ArrayLike, Nbar: ArrayLike, h: ArrayLike, laws: Mapping[str, Law]
) -> np.ndarray:
    """Whether asperities feel the coated body.

    Parameters
    ----------
    base, micro, asperities_on : words
    Nbar, h : in the same unit of length, any; all arguments broadcast
    laws : name -> law, for the words of `micro`

    Returns
    -------
    numpy.ndarray of bool : they can, and `asperities_on` is "layer", or it is "auto" and their pitch is above h
    """
    words = np.asarray(asperities_on)
    where = (words == "layer") | (words == "auto") & far_apart(Nbar, h)
    if not where.any():  # the usual case
        return np.zeros(np.broadcast_shapes(where.shape, np.shape(base), np.shape(micro)), dtype=bool)
    return can_feel(base, micro, laws) & where


def _array(name, value, table):
    parameter = table.get(name, Parameter())
    if parameter.choices:
        array = np.asarray(value, dtype=str)
        unknown = sorted(set(array.ravel()) - set(parameter.choices))
        if unknown:
            raise ValueError(f'{name} = "{unknown[0]}": must be one of {", ".join(parameter.choices)}')
        return array
    return np.asarray(value, dtype=int if parameter.whole else float)


def _missing(parameters, arrays, table):
    """Yield a message for each parameter without a default that some case needs and that is not in `parameters`."""
    if is_stack(arrays["base"]).any() and not layers.numbers_of(parameters):
        yield 'layers are missing: base = "stack" needs them'
    for name, row in table.items():
        if row.default is None and not {name, row.instead} & {*parameters} and row.instead != "":
            selector, needing = row.needed_by
            words = [f'"{word}"' for word in needing if word in arrays[selector]]
            if words:
                either = f" or {row.instead}" * bool(row.instead)
                yield f"{name}{either} is missing: {selector} = {' or '.join(words)} needs it"
