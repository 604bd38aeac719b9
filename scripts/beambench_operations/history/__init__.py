"""The history of runs on one machine, and its alarms: cells that got slower or wrong."""
