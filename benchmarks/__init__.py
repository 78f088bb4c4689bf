"""Speed and memory of beltrami beside the libraries that people use today.

``python -m benchmarks`` measures every row and writes BENCHMARKS.md; see ``README.md`` here.
"""
