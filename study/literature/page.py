"""The page docs/literature.md: its words stand here, its tables are those of the recipes."""

import sys
from pathlib import Path

from ..figures.formats import formatted
from ..figures.registry import TABLES, open_studies
from . import shown  # noqa: F401  which puts the tables into the register

PAGE = """# The formulas of the literature beside the exact layer

`make literature` computes the contacts of the three studies `studies/literature*.toml` and writes this page and its
figure; nothing on it is written by hand but its words. "Exact" is base = "layered" with a smooth
punch, solved to 1e-9 on a rigid base and to 1e-8 on a half-space. Few of the original papers could be read here: each
row says where the constants of its formula were read, and the errors are those of the formula as it stands there.

![Error of published formulas against the exact layer](literature.png)

## Load at one depth, on a rigid base

{literature}

1% and 5%: the a/h, from 0.01 to 20, up to which a formula errs by less, or from which on if it is one of thin layers;
"nowhere": not even at the end of that range. F_H is the load of Hertz at the same depth. A layer without friction has
the same F/F_H for every Poisson ratio; a bonded one has not. The general form of Dimitriadis depends on ν without
friction too, and is best near ν = 0.3. Hayes and others gave tables; what errs here at small a/h is the parabolas that
were fitted to them. Thin layers tend to Johnson's springs, or are squeezed out where they are bonded and
incompressible; how slowly they do so near ν = 1/2 is seen in the last rows.

## Stiffness on a coated half-space

{literature_coatings}

The stiffness dP/dD of a smooth contact is that of a flat punch of its radius, 2 a E_eff, whatever its shape. Doerner
and Nix leave α to the experiment: the row has for each n the α that makes its largest error smallest, so that no other
does better. King's own α, a function of a/h, was not to be had. Formulas of Poisson ratios that differ are not judged
here.

## Where they differ

F/F_H = 1 + c1 χ + c2 χ² + c3 χ³ + ... with χ = sqrt(R D)/h, on a rigid base; the exact coefficients are fitted to the
exact contacts of a/h up to 0.15. κ is the stiffness of a flat punch over 2 E1* a; a half-space of the layer has κ = 1.

{literature_decided}

- **Dimitriadis or Garcia?** To second order F/F_H of a bonded layer has c2 = (7/6) c1², which Garcia and Garcia have;
  Dimitriadis has c1². A short series is no use beyond the a/h of the first table.
- **Which κ of Hayes?** Two programs quote one table for ν = 1/2. The larger numbers are within 1 % of the exact ones
  up to a/h = 2. The smaller ones are up to 16.5 % too low: within 1 % they are those of ν = 0.48.
- **Which F of Hay and Crawford?** 0.0626: with 0.626, as one file has it, a stiff coating is far off.
- **Gao** is exact to first order in n - 1 and to no other: it is a formula of layers hardly different from their base.
  The composite Poisson ratio in the same documentation has a sign that makes it 2 - ν of two equal ones; it must be
  1 - ..., not 1 + ....

## Asperities of random heights

{literature_rough}

The asperities have normal heights of the standard deviation σ, cut at 5 σ; α = σ R/a² with a of Hertz, and
μ = (8/3) N̄ σ sqrt(2 R Ra). The pressure in the middle, and the effective radius (3π/4) ∫ r p dr/∫ p dr, are over those
of Hertz. Greenwood and Tripp leave out that asperities press down their neighbours: their equations were solved for
this page (`tests/references/make_greenwood_tripp.py`). "With neighbours" is the law `normal_heights`; without its mean
field it has their numbers to 5e-4 (`tests/laws/test_heights.py`). The more of the area the spots cover, the closer it
is to Hertz.

- **Does roughness change Hertz by less than 7 % where α < 0.05?** Greenwood, Johnson and Matsubara (1984) are quoted
  so. It is right for the pressure, and for the radius as well, where μ is 4 or more. With few asperities, μ = 1, the
  pressure is 12 % lower at α = 0.05.
"""


def markdown(name: str, results) -> str:
    """A table of the register in Markdown."""
    table = TABLES[name]
    cells = [[column.text for column in table.columns], ["---"] * len(table.columns)]
    cells += formatted(table, table.rows(*open_studies(name, TABLES, results)))
    return "\n".join(f"| {' | '.join(row)} |" for row in cells)


def page(results="results") -> str:
    """The text of the page, from the results of its studies."""
    names = ("literature", "literature_coatings", "literature_decided", "literature_rough")
    return PAGE.format(**{name: markdown(name, results) for name in names})


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(page(), encoding="utf-8")
