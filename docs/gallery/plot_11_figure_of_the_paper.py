"""
Figure 7 of the paper
=====================

The nominal pressure of rough and smooth contacts, with the paper's thin soft layer and without.
"""

import matplotlib.pyplot as plt

import roughcoat as rc

own = {"P": 2.704e-5, "h": 0.02, "n": 0.5, "bonding": "frictionless", "Nbar": 250000, "Ra": 0.004}
contacts = rc.solve(**own, base=["thin_layer", "half_space"], micro=["power_law", "smooth"], B=0.1, beta=0.5, x=201)

# %%
# Asperities spread the pressure: its largest value falls, and the contact is wider. So does the layer.
p0, a = contacts.p0, contacts.a
assert (p0.sel(micro="power_law") < p0.sel(micro="smooth")).all()
assert (a.sel(base="thin_layer") > a.sel(base="half_space")).all()

figure, axes = plt.subplots(figsize=(6, 4))
for base, number in (("thin_layer", "1"), ("half_space", "2")):
    for micro, prime in (("power_law", ""), ("smooth", "'")):
        one = contacts.sel(base=base, micro=micro)
        axes.plot(one.x * one.a, one.p * 100, label=f"{number}{prime}: {micro}, {base}".replace("_", " "))
axes.set(xlabel="r/R", ylabel="p/(10⁻² E2*)")
axes.legend(fontsize=8)
