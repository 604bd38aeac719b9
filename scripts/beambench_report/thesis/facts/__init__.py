"""What the report states beside the sweeps: counts that single commands of beambench print.

`gather` runs the commands and keeps what they print in folders beside the runs; each of the other
modules reads one of these folders and makes a section of the report of it.
"""
