// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.GraphicsConfiguration;
import java.awt.Insets;
import java.awt.Rectangle;
import java.awt.Toolkit;
import java.awt.Window;
import java.awt.event.WindowAdapter;
import java.awt.event.WindowEvent;
import javax.swing.JFrame;
import javax.swing.WindowConstants;

import rhotrack.spy.scene.Feed;
import rhotrack.spy.scene.Model;

/** The window; the subscription that feeds it ends with it. */
final class ViewerWindow {
    private final JFrame frame = new JFrame("rhotrack");
    private final ViewerPanel panel;

    ViewerWindow(Model model, Feed feed, int width, int height) {
        panel = new ViewerPanel(model);
        frame.setDefaultCloseOperation(WindowConstants.DISPOSE_ON_CLOSE);
        frame.setContentPane(panel);
        frame.setSize(width, height);
        frame.setLocationByPlatform(true);
        frame.addWindowListener(new WindowAdapter() {
            @Override
            public void windowClosed(WindowEvent event) {
                panel.stop();
                feed.close();
            }
        });
    }

    /** The other one goes to the edge where the screen has room for both only so. */
    void placeBeside(Window other) {
        GraphicsConfiguration where = other.getGraphicsConfiguration();
        Insets edges = Toolkit.getDefaultToolkit().getScreenInsets(where); // of the desktop's bars
        Rectangle screen = where.getBounds();
        screen.x += edges.left;
        screen.y += edges.top;
        screen.width -= edges.left + edges.right;
        screen.height -= edges.top + edges.bottom;
        Rectangle moved = new Rectangle(other.getLocationOnScreen(), other.getSize());
        Rectangle place = Placement.beside(screen, moved, frame.getSize());
        if (place == null) {
            moved.x = screen.x;
            place = Placement.beside(screen, moved, frame.getSize());
        }
        if (place != null) { // else where the desktop puts it
            other.setBounds(moved);
            frame.setLocationByPlatform(false);
            frame.setBounds(place);
        }
    }

    void open() {
        panel.start();
        frame.setVisible(true);
        panel.requestFocusInWindow(); // its keys work only while something in the window has the focus
    }

    boolean isOpen() {
        return frame.isDisplayable();
    }

    void toFront() {
        frame.setExtendedState(frame.getExtendedState() & ~JFrame.ICONIFIED);
        frame.toFront();
    }

    void whenClosed(Runnable job) {
        frame.addWindowListener(new WindowAdapter() {
            @Override
            public void windowClosed(WindowEvent event) {
                job.run();
            }
        });
    }
}
