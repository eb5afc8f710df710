"""
Stresses in a hard coating
==========================

A hard layer that bends over a soft body is in tension at its lower side, where it cracks.
"""

import roughcoat as rc

contact = rc.solve(R="3 mm", layer="ta-C", h="20 um", bonding="bonded", body="PEEK", P="5 N", micro="smooth")
largest = rc.extremes(contact)
print({name: f"{largest[name].item() / 1e9:.2f} GPa" for name in ("mises1", "mises2", "s1_layer", "sr_interface1")})

# %%
# The tension there exceeds the pressure in the centre several times.
assert largest.s1_layer > 2 * contact.p0 and largest.s1_layer_z * contact.a > 0.9 * contact.h

rc.plot_stresses(contact)
