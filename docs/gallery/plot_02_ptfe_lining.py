"""
A lining of PTFE
================

A soft layer that slides on steel, pressed by a rough ball: the thin-layer equation of the paper beside the exact layer.
"""

import matplotlib.pyplot as plt
import numpy as np

import roughcoat as rc

lining = {"layer": "PTFE", "h": "50 um", "bonding": "frictionless", "body": "steel 52100", "R": "50 mm"}
rough = {"punch": "steel 52100", "Nbar": "0.2 1/um^2", "Ra": "5 um"}
loads = [f"{load:.4g} N" for load in np.geomspace(0.1, 6, 9)]
contacts = rc.solve(**lining, **rough, base=["layered", "thin_layer"], P=loads, x=2)

# %%
# The wider the contact is against the layer, the better the thin layer is; `model_error` says how good.
a = contacts.a.sel(base="layered")
error = abs(contacts.a.sel(base="thin_layer") / a - 1)
assert error[-1] < error[0]

figure, axes = plt.subplots(figsize=(6, 4))
axes.loglog(a / contacts.h, error, label="error of a")
axes.loglog(a / contacts.h, contacts.model_error.sel(base="thin_layer"), "--", label="model_error")
axes.set_xticks([3, 4, 5, 6, 8], ["3", "4", "5", "6", "8"])
axes.set_yticks([0.02, 0.05, 0.1, 0.2], ["0.02", "0.05", "0.1", "0.2"])
axes.minorticks_off()
axes.set(xlabel="a/h", ylabel="relative error of the thin layer")
axes.legend()
