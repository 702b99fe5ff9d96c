"""What is said when something is wrong: findings with their places, and every sentence by its code."""
