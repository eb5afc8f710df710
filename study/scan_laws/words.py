"""The laws of the words "scan:FILE" of a study, which are computed before its contacts."""

import json
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from types import MappingProxyType
from typing import TextIO

import numpy as np

from solver.laws import own_table
from solver.numerics.caches import Cache

from ..inputs.definition import Definition, StudyError
from ..inputs.lexicon import lexicon_of
from ..inputs.punch.pressed_body import body_in
from ..inputs.punch.scan_words import ScanWord, content_of, scan_in

#: Tables of the last scans, some 3 kB each, by the versions of their laws.
_TABLES = Cache(1_000_000)


def with_rows(
    definition: Definition, stream: TextIO | None = None, computed: Mapping[str, str] = MappingProxyType({})
) -> Definition:
    """The definition with the laws of its scans, computed. The text of each is in its `tables`.

    stream : where it says how far it is
    computed : version -> text of each law that has been computed before

    Raises StudyError: a scan cannot be used, or has changed since the definition was read.
    """
    if not definition.scans:
        return definition
    known, tables = definition.grid.lexicon.known, {}
    for word in definition.scans:
        if word.version in computed:
            tables[word.name] = computed[word.version]
        else:
            bytes_of = partial(_bytes_of, word, definition, stream)
            tables[word.name] = _TABLES.get(word.version, bytes_of).tobytes().decode()
        known = known.with_law(own_table.of_scan(word.name, tables[word.name], word.version))
    lexicon = lexicon_of(known)
    grid, scene = replace(definition.grid, lexicon=lexicon), replace(definition.scene, lexicon=lexicon)
    return replace(definition, grid=grid, scene=scene, scans=(), tables=tables)


def _bytes_of(word: ScanWord, definition: Definition, stream: TextIO | None) -> np.ndarray:
    """The bytes of the table of a law. Raises StudyError."""
    from .law import law_up_to  # few contacts have a scan, and it imports scipy.fft and scipy.ndimage

    begins = f"{definition.name}: micro = {json.dumps(word.name, ensure_ascii=False)}"
    try:
        scan = scan_in(own_table.OF_SCAN + word.file, word.path)
        if content_of(scan) != word.content:
            raise ValueError("has changed since the study was read: start again")
        body = body_in(word.case, word.metre, definition.grid.lexicon)
        return np.frombuffer(law_up_to(scan, body, word.top, stream).text.encode(), np.uint8)
    except ValueError as error:
        raise StudyError([f"{begins}: {error}"]) from None
