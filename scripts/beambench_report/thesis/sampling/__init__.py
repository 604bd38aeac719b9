"""Object-space sampling, the thesis's future work: `beambench sampling SCENE --json`, shown."""
