"""
A steel ball on DLC on steel
============================

A coating as stiff as its body hardly changes the contact. The band is what the spreads of the inputs make of the
pressure.
"""

import roughcoat as rc

ball = {"R": "5 mm", "punch": "steel 52100", "micro": "smooth"}
coated = {"layer": "DLC a-C:H", "h": "2 um", "bonding": "bonded", "body": "steel 52100"}
contact = rc.solve(**ball, **coated, P=["1 N", "10 N", "100 N"], x=201)
print(rc.summary(contact.sel(P=10)))

# %%
# The same ball on bare steel differs by less than the ± of DLC's modulus makes.
bare = rc.solve(**ball, body="steel 52100", base="half_space", P=["1 N", "10 N", "100 N"])
assert (abs(contact.a / bare.a - 1) < 0.02).all()

figure = rc.plot(contact, "x", "p", hue="P")
figure
