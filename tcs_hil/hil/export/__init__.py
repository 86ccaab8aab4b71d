"""Everything a run left, on one time base, in the formats other tools open."""
