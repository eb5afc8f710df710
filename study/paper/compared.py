"""Every number that the paper prints, beside ours."""

import xarray as xr

from ..data.derived import nominal_area_ratio
from ..figures.registry import pick, table
from . import numbers
from .law_fits import bound, fitted, printed_error


@table(
    "paper_numbers",
    "reference_load",
    "main_case",
    columns="""
    quantity
    paper | .4g
    roughcoat | .5e
    difference | +.2%""",
)
def paper_numbers(reference: xr.Dataset, main: xr.Dataset) -> list[tuple]:
    """Numbers printed in the paper and the converged ones of the same model.

    Of a bound it tells whether it holds.
    """
    rough, homogeneous = (pick(main, label=f"rough, {base}") for base in ("layered", "homogeneous"))
    Ra, Nbar, *_ = numbers.TABLE1[0]
    fit = fitted(Ra, Nbar)
    ours = {"P": reference["P"]}
    ours |= {name: rough[name] for name in ("p0", "Ar_An", "p_max", "D", "A0")}
    ours |= {"An_ratio": nominal_area_ratio(homogeneous, reference["a"])}
    ours |= {f"{name} homogeneous": homogeneous[name] for name in ("Ar_An", "p_max")}
    ours |= {f"D smooth {base}": pick(main, label=f"smooth, {base}")["D"] for base in ("layered", "homogeneous")}
    ours |= {"B": fit.B / Ra, "beta": fit.beta}
    rows = [
        (quantity, printed, float(ours[key]), float(ours[key]) / printed - 1)
        for key, (quantity, printed) in numbers.NUMBERS.items()
    ]
    for Ra, Nbar, B, beta in numbers.TABLE1[:3]:
        error, density = printed_error(Ra, Nbar, B, beta), Nbar * Ra**2
        holds = "holds" if error <= numbers.ERROR_BOUNDS[round(density, 9)] else "does not hold"
        rows.append((f"error of the paper's fit, N Ra^2 = {density:g}", bound(Ra, Nbar), error, holds))
    return rows
