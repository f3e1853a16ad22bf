"""Benchmarks anyone can run: work against precision, cost against size, start-up."""
