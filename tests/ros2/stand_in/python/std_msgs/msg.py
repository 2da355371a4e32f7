class Float64MultiArray:
    def __init__(self):
        self.data = []


class Header:
    def __init__(self):
        self.stamp, self.frame_id = None, ""
