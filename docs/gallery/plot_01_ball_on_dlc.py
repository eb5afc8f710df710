"""
A steel ball on DLC on steel
============================

A coating as stiff as its body hardly changes the contact. The band is the ± of the pressure from the spreads of the
inputs.
"""

import roughcoat as rc

ball = {"R": "5 mm", "punch": "steel 52100", "micro": "smooth"}
coated = {"layer": "DLC a-C:H", "h": "2 um", "bonding": "bonded", "body": "steel 52100"}
contact = rc.solve(**ball, **coated, P=["1 N", "10 N", "100 N"], x=201)
print(rc.summary(contact.sel(P=10)))

# %%
# On bare steel the same ball has the same contact radius, to 2 %.
bare = rc.solve(**ball, body="steel 52100", base="half_space", P=["1 N", "10 N", "100 N"])
assert (abs(contact.a / bare.a - 1) < 0.02).all()

figure = rc.plot(contact, "x", "p", hue="P")
figure

# %%
# The scan that comes with roughcoat has asperities. They carry the same load at a much higher pressure. A warning says
# that they would yield.
scan = rc.roughness.read(rc.samples.scan())
asperities = rc.roughness.measure(scan, method="summits", cutoff=2e-6).parameters()
rough = rc.solve(**(ball | asperities), **coated, P="10 N", profiles=False)
print(f"{rough.p_max.item() / 1e9:.1f} GPa at an asperity, {contact.p0.sel(P=10).item() / 1e9:.2f} GPa without")
assert rough.p_max.item() > 2 * contact.p0.sel(P=10).item()
