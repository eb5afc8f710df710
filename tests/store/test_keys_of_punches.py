"""What describes a shape or adhesion is in the key of a case and in the digest of its study."""

import pytest
from punched import PUNCH, punched

from study.inputs.identity import case_keys


@pytest.mark.parametrize("name", PUNCH)
def test_every_parameter_of_a_punch_is_in_key_and_digest(name):
    first, second = PUNCH[name][1]
    one, same, other = (punched(name, value) for value in (first, first, second))
    assert (case_keys(one.grid) == case_keys(same.grid)).all() and one.digest == same.digest
    assert (case_keys(one.grid) != case_keys(other.grid)).all() and one.digest != other.digest
