"""The command `check`. It answers at once, since it imports neither xarray nor netCDF4."""

import numpy as np

from ..inputs.checks import unloading
from ..inputs.definition import Definition
from ..inputs.lexicon import PACKAGE
from ..inputs.places import study_file
from ..inputs.reading import read
from ..inputs.vocabulary import ROWS, VOCABULARY
from ..terminal import answer


def check(_, file: str) -> int:
    """Read a study file and say its size."""
    definition = read(study_file(file))
    size = f"{file}: {definition.cases}, digest {definition.digest[:16]}"
    return answer(size, *law_lines(definition), *assumed_lines(definition), *doubtful_lines(definition))


def assumed_lines(definition: Definition) -> list[str]:
    """A line on inputs that matter and that a study with units does not give; otherwise none."""
    names = definition.scene.assumed if definition.scene else ()
    texts = [f"{name} = {PACKAGE.parameter(name if name in VOCABULARY else 'nu1').default}" for name in names]
    texts += ["a rigid punch"] * bool(definition.scene and "E_punch" not in definition.scene.values)
    return ["    assumed, as not given: " + ", ".join(texts)] * bool(texts)


def doubtful_lines(definition: Definition) -> list[str]:
    """Lines on doubts about a study: loads that fall though asperities yield; and with units, inputs that no real body
    has, such as 210 TPa, spreads that are too wide, and assumptions that contacts are far outside of."""
    if not definition.scene:
        return [f"{definition.name}: beware: {text}" for text in unloading(definition)]
    from ..in_words.sentences import far_outside
    from ..inputs.scene.scene import bare_variable  # here: these import xarray
    from ..rules.rule import sentences

    scene, v = definition.scene, {}
    for name, value in (scene.values | {f"{name}_spread": spread for name, spread in scene.spreads.items()}).items():
        v[name] = bare_variable(value, {"units": ROWS[name].unit} if name in ROWS else {})
    return [
        f"{definition.name}: beware: {text}"
        for text in (*sentences(v), *unloading(definition), *far_outside(definition))
    ]


def law_lines(definition: Definition) -> list[str]:
    """A line on the power law of a study, if it is fitted; otherwise none."""
    if not definition.grid.fitted:
        return []
    ends = [np.unique(definition.grid.values[name][1])[[0, -1]] for name in ("B", "beta")]
    B, beta = (f"{low:.4g}" if low == high else f"{low:.4g} to {high:.4g}" for low, high in ends)
    return [f"    power law fitted to Nbar and Ra: B = {B} (in Ra/E1*^beta), beta = {beta}"]
