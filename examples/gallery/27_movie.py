"""A movie.

The camera goes with the cell. MP4 for talks, GIF for pages; frames are spread so that the whole
run takes the time asked for.
"""

import imageio_ffmpeg

import cellcrawl as cc

cell = cc.Parameters(r_on=24, zeta_1=540)
run = cc.simulate(cell, t_end=40, start=cc.RandomPerturbation(seed=1)).sel(time=slice(12, None))
made = cc.movie(run, "27_movie.mp4", seconds=4, size=(480, 480))
cc.movie(run, "27_movie.gif", seconds=4, fps=10, size=(320, 320))
cc.plot.cell(run, time=25.0).figure.savefig("27_movie.png", dpi=130)

frames, seconds = imageio_ffmpeg.count_frames_and_secs("27_movie.mp4")
turned = cc.observables.heading(run)
print(made, frames, "frames", seconds, "s; turned by", float(turned[-1] - turned[0]))
assert abs(seconds - 4) < 0.1
assert frames == 100
# In 28 time units it turns 28 / 12.9350 times by 1.2225: the exact rotation of (24, 540).
assert abs(abs(float(turned[-1] - turned[0])) - 1.2225 * 28 / 12.935) < 0.7
