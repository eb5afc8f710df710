"""Data to try: a scan and a force curve. Both are synthetic, so that the right answers are known.

Examples
--------
>>> import study
>>> scan = study.roughness.read(study.samples.scan())
>>> scan.z.shape
(96, 96)
>>> study.curves(study.samples.curve()).sizes["point"]
100
"""

from pathlib import Path

_FOLDER = Path(__file__).parent


def scan() -> Path:
    """A synthetic scan of a rough surface, which `roughcoat scan` reads without an option.

    It is a map of 96 by 96 heights every 0.25 µm in the text format of ISO 25178-71, one period of a random surface
    with normal heights, waves of 2 µm and longer, a standard deviation of the heights of 50 nm, and a root mean
    square of the slope along x of 0.0432.

    Returns
    -------
    pathlib.Path : scan.sdf in the package

    Examples
    --------
    >>> scan().name
    'scan.sdf'
    """
    return _FOLDER / "scan.sdf"


def curve() -> Path:
    """A synthetic force curve of a rigid bead on a gel bonded to glass, for `roughcoat fit` and `study.fit`.

    The bead has R = 5 µm. The gel has h = 1.5 µm, nu1 = 0.49 and E1 = 5 kPa, the glass E2 = 70 GPa and nu2 = 0.2. The
    noise of the load has a standard deviation of 3 pN; contact point and baseline are 0.

    Returns
    -------
    pathlib.Path : curve.csv in the package, 100 rows with the columns D [nm] and P [nN]

    Examples
    --------
    >>> from study import curves
    >>> print(*curves(curve()).data_vars)
    D P
    """
    return _FOLDER / "curve.csv"
