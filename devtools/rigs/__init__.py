"""One recorded jump on the skeletons of many conventions: are they mapped, and adapted alike?"""
