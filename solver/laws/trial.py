"""A search for mistakes in a user's law: in its declaration, and in its functions at a few of its cases."""

import traceback
from contextlib import contextmanager
from pathlib import Path
from weakref import WeakSet

import numpy as np

from ..numerics.caches import shared_lock
from ..parameters import Parameter, allowed, ends
from .law import Curve, Law
from .own_table import OF_FILES

#: The y (cases, points) of a trial: three cases at different y. At _ZERO times these y, q and g must be below _NEAR
#: times their values at these y, since they rise as y² or faster. Numbers below _TINY may have fewer digits than
#: others.
_Y = np.array([[0.9], [1.0], [1.1]]) * np.geomspace(1e-3, 10, 13)
_ZERO, _NEAR, _TINY = 1e-6, 1e-3, 1e-290
#: Half the step of ln y of a difference with which a derivative is compared, and the largest relative error of the
#: derivative: in the laws of this package it is less than 1e-5 (tests/laws/test_trial.py).
_STEP, _WRONG = 1e-3, 1e-3
#: A curve that changes by less than _FLAT over the step is flat: its derivative is rounding. So is a fall by less than
#: _ROUNDING from one y to the next.
_FLAT, _ROUNDING = 1e-6, 1e-9
#: A law is refused if more than this part of the points is wrong: a curve may have a corner near some points.
_PART = 0.25
#: Largest relative error of q or g at the y that an inverse returns.
_INVERSE = 1e-6
#: The laws whose functions have been tried.
_TRIED: WeakSet[Law] = WeakSet()
_trying = shared_lock()


def untried(law):
    """Whether a law is a user's, and its functions have not been tried."""
    if not law.version or law.name.startswith(OF_FILES):
        return False
    with _trying:
        return law not in _TRIED


def try_out(law, E, parameters):
    """Try the functions of a law that is :func:`untried` at some of its cases: see :func:`tried`.

    This takes a seventh of a millisecond, once in a process. Without it a law with a wrong derivative gives a dP/dD
    that is 2 % off, with the status of a converged case (tests/laws/test_trial.py).
    """
    if untried(law):
        tried(law, E, parameters)
        with _trying:
            _TRIED.add(law)


@contextmanager
def going_on():
    """Context in which a user's functions cannot end Python: it raises RuntimeError in place of SystemExit and its
    like."""
    try:
        yield
    except (Exception, KeyboardInterrupt):
        raise
    except BaseException as error:
        what = f"calls sys.exit({error})" if isinstance(error, SystemExit) else f"raises {type(error).__name__}"
        raise RuntimeError(f"it {what}, which would end the program") from error


def declaration(law):
    """A sentence about the first mistake in the declaration of a law's parameters; "" if there is none."""
    if not isinstance(law.parameters, dict):
        return "parameters must be a dictionary, name -> Parameter"
    for name, parameter in law.parameters.items():
        if not (isinstance(name, str) and name.isidentifier() and name[0] != "_"):
            return f"the parameter {name!r} must have a name of letters, digits and _"
        if not isinstance(parameter, Parameter) or parameter.choices or not _is_interval(parameter.interval):
            return f'the parameter {name} must be a Parameter with an interval such as "(0, 1.57)", and no choices'
        if not (parameter.default is None or allowed(parameter, parameter.default)):
            return f"the parameter {name} has the default {parameter.default}, outside {parameter.interval}"
        if not (isinstance(parameter.powers, tuple) and [type(power) for power in parameter.powers] == [int, int]):
            return f"the parameter {name} must have powers of two whole numbers, (i, j) of E2*^i R^j"
    return ""


def _is_interval(text):
    try:
        low, high, *_ = ends(text)
    except (TypeError, ValueError):
        return False
    return low < high and text[0] in "[(" and text[-1] in "])"


@np.errstate(all="ignore")
def tried(law, E, values):
    """Try a law at three of its cases; E (B,) is their modulus, `values` their parameters, name -> (B,).

    The trial finds mistakes that would make a wrong number look right, or raise an error deep in the solver. NaN is not
    a mistake: such a case gets a status. Raises ValueError if a function of the law raises or returns something of a
    wrong shape, if q or g do not increase from 0, or if a derivative or an inverse is not that of the curve.
    """
    places = np.linspace(0, len(E) - 1, len(_Y)).astype(int)
    E, values = E[places], {name: values[name][places] for name in law.arguments}
    bound, curve, area = _shapes(law, E, values)
    # no contact is beyond full contact or has p above E: a law may return anything there
    here = (area <= 1) & (bound.p_star[:, None] * curve.q <= E[:, None])
    small, above, below = (_curve(law, y, bound.own) for y in (_ZERO * _Y, _Y * np.exp(_STEP), _Y * np.exp(-_STEP)))
    for name, inverse in (("q", "from_pressure"), ("g", "from_displacement")):
        at, falls = getattr(curve, name), np.zeros(_Y.shape, bool)
        falls[:, 1:] = here[:, 1:] & here[:, :-1] & (at[:, 1:] < at[:, :-1] * (1 - _ROUNDING))
        falls |= here & (getattr(small, name) > _NEAR * at)
        if falls.any():
            _refuse(law, f"curve: {name} must increase from 0 at y = 0", values, falls)
        slope = np.log(getattr(above, name) / getattr(below, name)) / (2 * _STEP)  # of ln q over ln y
        numbers, checked = (slope, _Y * getattr(curve, f"d{name}") / at, _WRONG), here & (at > _TINY)
        rising = checked & (slope > _FLAT / _STEP)
        _compare(law, f"curve: d{name} must be the derivative of {name} by y", numbers, rising, values)
        if getattr(law, inverse):
            returned = _curve(law, _of_shape(law, inverse, at, *bound.own), bound.own)
            numbers = at, getattr(returned, name), _INVERSE
            _compare(law, f"{inverse} must be the inverse of {name} of curve", numbers, checked, values)


def _shapes(law, E, values):
    """The law bound to its cases, its curve, and its area at _Y. Raises ValueError if one of its functions does not
    return arrays of the right shape."""
    parts = _called(law, "scales", E, **values)
    if not (isinstance(parts, (tuple, list)) and len(parts) >= 2 and all(np.shape(v) in ((), E.shape) for v in parts)):
        _refuse(law, "scales must return p*, A* and what else the functions need, each of the shape of E")
    bound = law.bind(E, **values)
    curve, edge = _curve(law, _Y, bound.own), _called(law, "edge", *bound.own)
    if not (isinstance(edge, (tuple, list)) and len(edge) == 2):
        _refuse(law, "edge must return two values, gamma and beta")
    for name, value in (("edge", edge[0]), ("edge", edge[1]), ("peak", _called(law, "peak", _Y, curve.q, *bound.own))):
        _broadcasts(law, name, value, _Y)
    if law.touching:
        A = bound.A_star * curve.g[:, 0]
        _broadcasts(law, "touching", _called(law, "touching", A, **values), A)
    return bound, curve, _of_shape(law, "area", _Y, curve.q, *bound.own)


def _compare(law, rule, numbers, checked, values):
    """Refuse a law if two arrays differ at too many of the points where `checked`. numbers : the right values, those of
    the law, and their largest relative difference."""
    right, stated, most = numbers
    checked = checked & np.isfinite(right) & np.isfinite(stated)
    wrong = checked & (np.abs(stated - right) > most * np.abs(right))
    if wrong.sum() > _PART * checked.sum():
        _refuse(law, rule, values, wrong)


def _curve(law, y, own):
    curve = _called(law, "curve", y, *own)
    if not isinstance(curve, Curve) or any(np.shape(values) != y.shape for values in curve):
        _refuse(law, "curve must return a Curve of four arrays of the shape of y, (cases, points)")
    return curve


def _of_shape(law, name, y, *further):
    values = _called(law, name, y, *further)
    if np.shape(values) != y.shape:
        _refuse(law, f"{name} must return an array of the shape of y, (cases, points)")
    return values


def _broadcasts(law, name, values, y):
    try:
        right = np.broadcast_shapes(np.shape(values), y.shape) == y.shape and np.asarray(values).dtype.kind in "fiub"
    except ValueError:
        right = False
    if not right:
        _refuse(law, f"{name} must return numbers, one for all or one for each of what it is given")


def _called(law, name, *arguments, **named):
    try:
        with going_on():
            return getattr(law, name)(*arguments, **named)
    except MemoryError:
        raise
    except Exception as error:
        at = traceback.extract_tb(error.__traceback__)[-1]
        where = f" ({Path(at.filename).name}, line {at.lineno})" * (at.filename != __file__)
        raise ValueError(f"micro law {law.name}: {name} raises {type(error).__name__}: {error}{where}") from error


def _refuse(law, reason, parameters=None, where=None):
    """Raise the ValueError of a mistake, with the first y and the parameters of the first case at which `where` is
    True."""
    if parameters is not None:
        case, point = np.argwhere(where)[0]
        numbers = {"y": _Y[case, point]} | {name: values[case] for name, values in parameters.items()}
        reason += " (at " + ", ".join(f"{name} = {value:.3g}" for name, value in numbers.items()) + ")"
    raise ValueError(f"micro law {law.name}: {reason}")
