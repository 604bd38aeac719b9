"""The thesis's cluster (chapter 6), simulated with the costs of real beams.

`record` runs the MPI program once for each scene, in one process, and keeps what every beam took;
`simulate` lets the same program run on machines and networks that SimGrid computes; `write` draws
figures 6.3 and 6.4 and what came of more processes, other options and unequal machines.
"""
