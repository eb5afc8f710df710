"""
The law of the scan itself
==========================

Spheres that are measured on a scan, or the scan itself, pressed point by point? A steel ball on PMMA has the roughness
of a random surface, in the place of your scan.
"""

import matplotlib.pyplot as plt

import roughcoat as rc

scan = rc.roughness.self_affine((96, 96), "0.25 um", hurst=0.8, rms="10 nm", shortest="3 um", seed=1)
law = rc.roughness.law(scan, periodic="given", progress=False)
print(law)

bodies = {"punch": "steel 52100", "body": "PMMA", "base": "half_space"}
of_scan = rc.solve(R="20 mm", P="50 mN", **bodies, micro=law)
of_spheres = rc.solve(R="20 mm", P="50 mN", **bodies, **rc.roughness.measure(scan).parameters())

# %%
# Spheres touch less: they leave out that neighbouring summits grow together. The law says its own error, which
# ``model_error`` contains.
assert of_scan.Ar_An > 1.2 * of_spheres.Ar_An and of_scan.model_error >= law.error

# %%
# The spots in the middle of the contact, under its nominal pressure p(0).
spots = rc.roughness.contact_map(scan, f"{float(of_scan.p0)} Pa", on=bodies, periodic="given")
assert abs(float(spots.pressure.mean()) / of_scan.p0 - 1) < 1e-6

figure, (left, right) = plt.subplots(1, 2, figsize=(8, 4), layout="constrained")
pressed = spots.pressure.where(spots.pressure > 0) / 1e6
image = left.imshow(pressed, origin="lower", extent=[0, 24, 0, 24], cmap="viridis_r")
left.set(xlabel="x, µm", ylabel="y, µm", title="spots in the middle")
figure.colorbar(image, ax=left, label="pressure, MPa", location="bottom")
for contact, words in ((of_scan, "the scan itself"), (of_spheres, "spheres")):
    right.plot(contact.x * contact.a * 1e6, contact.lam, label=words)
right.set(xlabel="r, µm", ylabel="real over nominal area λ")
right.legend()
