# SPDX-License-Identifier: MIT
"""The pictures of papers_initiation.py: the parameter space as in the paper's Figs. 7 to 10 and 15,
figures against noise, and times against clutter."""
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LinearSegmentedColormap

BLOCKS = (100, 125)  # of cells, along theta and rho
HISTOGRAM = (48, 56)
GREY_BELOW_TAU = LinearSegmentedColormap.from_list("votes", [
    (0, "#ffffff"), (0.001, "#d8d8d8"), (0.499, "#8a8a8a"), (0.5, "#f0d000"), (0.75, "#e06000"),
    (1, "#8b0000")])


def planes(report, situation, true_lines, rho_cell_m, votes_of):
    """A panel each method: the highest cell of each block."""
    rows = -(-len(votes_of) // 3)
    figure, axes = plt.subplots(rows, min(len(votes_of), 3), squeeze=False,
                                figsize=(12, 3.6 * rows), layout="constrained")
    for (method, votes), at in zip(votes_of.items(), axes.flat):
        blocks = highest(votes, BLOCKS)
        half_km = votes.shape[1] * rho_cell_m / 2e3
        image = at.imshow(blocks / (blocks.max() or 1), GREY_BELOW_TAU, vmin=0, vmax=1,
                          origin="lower", aspect="auto", extent=(-half_km, half_km, 0, np.pi))
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


def highest(votes, counts):
    """The highest cell of each block, of about so many along each axis."""
    for axis, count in enumerate(counts):
        size = -(-votes.shape[axis] // count)
        votes = np.maximum.reduceat(votes, np.arange(0, votes.shape[axis], size), axis=axis)
    return votes


def histograms(report, situation, rho_cell_m, votes_of):
    """As the paper draws them: votes over rho and theta, one panel each of (a) HT, (b) MHT, (c)
    IHT, (d) NHT, reading C."""
    panels = [(letter, method, votes_of[method]) for letter, method in zip(
        "abcd", ("HT", "MHT", "IHT", "NHT C")) if method in votes_of]
    figure = plt.figure(figsize=(12, 9))
    figure.subplots_adjust(0, 0, 0.96, 0.96, 0.02, 0.06)
    for place, (letter, method, votes) in enumerate(panels, 1):
        axes = figure.add_subplot(2, 2, place, projection="3d")
        blocks = highest(votes, HISTOGRAM)
        at = np.nonzero(blocks)
        half_km, height = votes.shape[1] * rho_cell_m / 2e3, blocks[at]
        width = 2 * half_km / blocks.shape[1], np.pi / blocks.shape[0]
        if height.size:  # a method may find no pair of plots in any cell
            axes.bar3d(at[1] * width[0] - half_km, at[0] * width[1], 0, *width, height,
                       rasterized=True, color=plt.get_cmap("turbo")(height / height.max()))
        axes.set(title=f"({letter}) {method}: votes", xlabel="rho (km)",
                 ylabel="theta (rad)", xlim=(-half_km, half_km), ylim=(0, np.pi))
        axes.view_init(28, -55)
        axes.set_box_aspect((4, 4, 2.6))
    report.figure(f"histograms-{situation.name.replace(' ', '-')}", figure,
                  f"{situation.figure} as in the paper. {situation.text}. One run; a bar is the "
                  "highest cell of a block.")


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
