"""Builds a small AC3D file: a road of a strip and a polygon, rotated and moved, and a triangle."""

TRACK = """AC3Db
MATERIAL "" rgb 0.4 0.4 0.4 amb 0.8 0.8 0.8 emis 0 0 0 spec 0.5 0.5 0.5 shi 50 trans 0
OBJECT world
kids 2
OBJECT group
loc 100 0 0
rot 0 0 1 0 1 0 -1 0 0
kids 1
OBJECT poly
name "road"
data 5
kids.
texture "Road.png" base
texture "shadow.rgb" tiled
numvert 5
0 0 0 0 1 0
1 0 0 0 1 0
0 0 1 0 1 0
1 0 1 0 1 0
2 0 1 0 1 0
numsurf 3
SURF 0x34
mat 0
refs 6
0 0 0
1 0 0
2 0 0
3 0 0
3 0 0
4 0 0
SURF 0x30
refs 4
0 0 0
1 0 0
3 0 0
2 0 0
SURF 0x22
mat 0
refs 2
0 0 0
1 0 0
kids 0
OBJECT poly
numvert 3
0 1 0
1 1 0
0 1 1
numsurf 1
SURF 0x10
mat 0
refs 3
0 0 0
1 0 0
2 0 0
kids 0
"""
