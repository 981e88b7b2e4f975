"""What an editor shows of a workspace while its files are typed."""
