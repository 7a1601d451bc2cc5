# SPDX-License-Identifier: MIT
"""The pictures of papers_initiation.py: the parameter space as in the paper's Figs. 7 to 10 and 15,
figures against noise, and times against clutter."""
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LinearSegmentedColormap

BLOCKS = (100, 125)  # of cells, along theta and rho
GREY_BELOW_TAU = LinearSegmentedColormap.from_list("votes", [
    (0, "#ffffff"), (0.001, "#d8d8d8"), (0.499, "#8a8a8a"), (0.5, "#f0d000"), (0.75, "#e06000"),
    (1, "#8b0000")])


def planes(report, situation, true_lines, rho_cell_m, votes_of):
    """A panel each method: the highest cell of each block."""
    rows = -(-len(votes_of) // 3)
    figure, axes = plt.subplots(rows, min(len(votes_of), 3), squeeze=False,
                                figsize=(12, 3.6 * rows), layout="constrained")
    for (method, votes), at in zip(votes_of.items(), axes.flat):
        blocks = votes
        for axis, count in enumerate(BLOCKS):
            size = -(-votes.shape[axis] // count)
            blocks = np.maximum.reduceat(blocks, np.arange(0, votes.shape[axis], size), axis=axis)
        half_km = votes.shape[1] * rho_cell_m / 2e3
        image = at.imshow(blocks / blocks.max(), GREY_BELOW_TAU, vmin=0, vmax=1, origin="lower",
                          aspect="auto", extent=(-half_km, half_km, 0, np.pi))
        at.plot(true_lines[0] / 1e3, true_lines[1], "o", ms=9, mfc="none", color="#0072b2",
                label="true lines")
        at.set(title=f"{method}: at most {blocks.max():.3g} votes", xlabel="rho (km)",
               ylabel="theta (rad)")
    axes.flat[0].legend(loc="upper right")
    for at in axes.flat[len(votes_of):]:
        at.axis("off")
    figure.colorbar(image, ax=axes, shrink=0.6,
                    label="highest cell of a block / highest of all\ngrey: below tau, not listed")
    report.figure(f"situation-{situation.name.replace(' ', '-')}", figure,
                  f"As {situation.figure}. {situation.text}. One run.")


def sweep(report, noises_m, summaries, colours):
    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 4.4), layout="constrained")
    for method in summaries[0]:
        left.plot([of[method]["detected"][0] for of in summaries], "o-", color=colours[method])
        right.plot([max(of[method]["false peaks"][0], 0.01) for of in summaries], "o-",
                   color=colours[method], label=method)
    for axes in (left, right):
        axes.set_xticks(range(len(noises_m)), [f"{noise_m:g}" for noise_m in noises_m])
        axes.set_xlabel("noise (m)")
    left.set(ylabel="share of the targets detected", ylim=(0, 1.05))
    right.set(ylabel="false peaks a run (none: .01)", yscale="log")
    right.legend()
    report.figure("noise", figure, "Targets detected, and false peaks, against the noise.")


def times(report, densities, of_density, colours):
    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 4.4), layout="constrained")
    names = {"HT": "HT, streamed", "whole plane": "HT, whole plane"}
    for method in of_density[0]:
        style = {"color": colours.get(method, "0.4"), "marker": "o",
                 "linestyle": "-" if method in colours else "--"}
        for at, axes in enumerate((right, left)):
            axes.loglog(densities[:len(of_density)], [of[method][at] for of in of_density], **style,
                        label=names.get(method, method))
    left.set(xlabel="clutter plots a square kilometre and scan", ylabel="votes")
    right.set(xlabel=left.get_xlabel(), ylabel="time of a search (ms)")
    right.legend()
    report.figure("times", figure, "Votes, and time of a search, against the clutter.")
