"""What is no physics: how kernels are compiled, elementary functions, cyclic systems, roots."""
