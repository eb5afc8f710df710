"""
What a result rests on
======================

How much the largest real pressure changes with each input, and which input contributes most to its ±.
"""

import roughcoat as rc

contact = rc.solve(
    R="10 mm",
    punch="steel 52100",
    layer="DLC a-C:H",
    h="20 ± 1 um",
    bonding="bonded",
    body="steel 52100",
    Nbar="0.2 1/um^2",
    Ra="5.0 ± 0.5 um",
    P="1 N",
)
rests = rc.sensitivities(contact).p_max_sensitivity
print(rests.to_series().round(3).to_string())

# %%
# Sharper asperities press harder. A load that is 1 % larger makes the pressure 0.1 to 0.3 % larger.
assert rests.sel(input="Ra") < 0 and 0.05 < rests.sel(input="P") < 0.4

figure = rc.plot(contact, "p_max", "input")
figure
